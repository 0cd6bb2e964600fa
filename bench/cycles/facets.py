"""How rough surfaces reflect light back to where it came from, by quadrature with numpy.

Written from the published formulas (docs/physics.md, section 4), sharing no code with the program.
"""
import numpy as np


def fresnel(cosine, ior):
    """Unpolarised reflectance of a dielectric of index `ior`, seen from air."""
    inside = np.sqrt(1.0 - (1.0 - cosine**2) / ior**2)
    s = (cosine - ior * inside) / (cosine + ior * inside)
    p = (ior * cosine - inside) / (ior * cosine + inside)
    return 0.5 * (s**2 + p**2)


def smith_lambda(cosine, alpha):
    """Smith's Lambda of GGX facets of width `alpha`."""
    return 0.5 * (np.sqrt(1.0 + alpha**2 * (1.0 / cosine**2 - 1.0)) - 1.0)


def directional_albedo(alpha, reflectance, cosines, points=(400, 256)):
    """Share of the light from each direction that GGX facets reflect at once.

    The facets' normals h are drawn evenly in u from D cos = du dphi / (2 pi), with
    tan^2 = alpha^2 u / (1 - u); what is left of F D G2 (wo.h) / cos_o dh is averaged.
    `reflectance` is a function of wo.h.
    """
    u = (np.arange(points[0]) + 0.5) / points[0]
    phi = (np.arange(points[1]) + 0.5) / points[1] * np.pi
    cos_h = np.sqrt((1.0 - u) / (1.0 - u + alpha**2 * u))[:, None]
    x_h = np.sqrt(1.0 - cos_h**2) * np.cos(phi)
    albedo = []
    for cos_o in cosines:
        o_dot_h = np.sqrt(1.0 - cos_o**2) * x_h + cos_o * cos_h
        cos_i = 2.0 * o_dot_h * cos_h - cos_o
        seen = (o_dot_h > 0.0) & (cos_i > 0.0)
        cos_i = np.where(seen, cos_i, 1.0)
        masking = 1.0 / (1.0 + smith_lambda(cos_o, alpha) + smith_lambda(cos_i, alpha))
        value = reflectance(np.clip(o_dot_h, 0.0, 1.0)) * masking * o_dot_h / (cos_o * cos_h)
        albedo.append(np.where(seen, value, 0.0).mean())
    return np.array(albedo)


def retro_colours(material, cosines):
    """What Cycles needs for a rough surface lit from beside the camera: two tables of colours.

    The body is a diffuse reflectance, the lobe a factor on D G1 G1 / (4 cos cos), Cycles' GGX. Both
    hold where the light comes from (nearly) where the camera is, so that one angle is enough:
      lobe = F(0) (1 + Lambda)^2 / (1 + 2 Lambda)     correlated over separable masking
      body = weight (1 - E)^2 / (1 - E_mean)
    `cosines` are those between the normal and the view.
    """
    alpha, coated = material["roughness"], material["type"] == "coated_diffuse"
    # E of a coat is its own; that of a metal is that of facets without loss.
    grid = np.linspace(0.0, 1.0, 101)[1:]
    albedo = directional_albedo(
        alpha, lambda c: fresnel(c, material["ior"]) if coated else np.ones_like(c), grid)
    e = np.interp(cosines, grid, albedo)
    e_mean = 2.0 * np.trapz(np.append(0.0, grid * albedo), np.append(0.0, grid))
    if coated:
        weight, facet = material["reflectance"], fresnel(1.0, material["ior"])
    else:
        facet = material["reflectance"]
        mean = facet + (1.0 - facet) / 21.0  # Schlick: 2 integral of (r + (1 - r) (1 - c)^5) c dc
        weight = mean**2 * e_mean / (1.0 - mean * (1.0 - e_mean))
    body = weight * (1.0 - e)**2 / (1.0 - e_mean)
    shadow = smith_lambda(cosines, alpha)
    return body, facet * (1.0 + shadow)**2 / (1.0 + 2.0 * shadow)
