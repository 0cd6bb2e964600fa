"""Renders an exported Retrolux scene with Cycles: an object, a camera, and its ring of diodes.

    blender -b --factory-startup -P blender_scene.py -- JOB.json

JOB.json: scene (folder of scene.json), threads, pattern (Cycles' sampling pattern), and `pictures`,
a list of {out, spp, seed, and perhaps threshold}. For each picture prints a line `picture {"wall_s": .., "cpu_s": ..}`.
Blender's unit is the metre, as in the .glb. A pixel's value is radiance in W/(m2 sr): emission
strengths are radiances and no colour management touches an EXR.
"""
import json
import math
import os
import sys
import time

import bpy
import numpy as np
from mathutils import Vector

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
import facets

np.bool = bool  # Blender 3.4's glTF importer asks for the name, which numpy 1.24 has dropped
LED_CORNERS = 12  # each diode is a regular polygon with the area of its disc
TABLE_SIZE = 2048
GRAZING = 0.02  # cosine below which a ring 1 degree beside the camera is not where the camera is
MAX_SURFACES = 6  # as the path tracer's: the first one and five bounces


def load(folder):
    """Imports mesh and camera; returns them with the description that was exported."""
    with open(os.path.join(folder, "scene.json")) as file:
        scene = json.load(file)
    bpy.ops.wm.read_homefile(use_empty=True)
    bpy.ops.import_scene.gltf(filepath=os.path.join(folder, scene["objects"][0]["file"]))
    mask = bpy.data.objects[scene["objects"][0]["name"]]
    # Cycles moves rays off the surface near the terminator unless told not to.
    mask.cycles.shadow_terminator_geometry_offset = 0.0
    mask.cycles.shadow_terminator_offset = 0.0
    camera = next(o for o in bpy.data.objects if o.type == "CAMERA")
    return scene, mask, camera


def set_camera(camera, spec):
    """The exact camera matrix: the importer only knows a field of view."""
    k, (width, height) = spec["camera_matrix"], spec["size"]
    render = bpy.context.scene.render
    render.resolution_x, render.resolution_y, render.resolution_percentage = width, height, 100
    render.pixel_aspect_x, render.pixel_aspect_y = 1.0, k[0] / k[4]
    camera.data.sensor_fit = "HORIZONTAL"
    camera.data.lens = camera.data.sensor_width * k[0] / width
    # Pixel (0, 0) is the centre of the top-left pixel.
    camera.data.shift_x = (0.5 * (width - 1) - k[2]) / width
    camera.data.shift_y = (k[5] - 0.5 * (height - 1)) * k[0] / k[4] / width
    bpy.context.scene.camera = camera


def add_ring(camera, ring):
    """Diodes as polygons that emit I0 cos^(m-1) / A, forward only."""
    area_m2 = math.pi * (1e-3 * ring["led_radius_mm"])**2
    corner_m = math.sqrt(2.0 * area_m2 / (LED_CORNERS * math.sin(2.0 * math.pi / LED_CORNERS)))
    vertices, faces = [], []
    for led in range(ring["count"]):
        turn = 2.0 * math.pi * led / ring["count"]
        x, y = (1e-3 * ring["radius_mm"] * f(turn) for f in (math.cos, math.sin))
        faces.append(range(len(vertices), len(vertices) + LED_CORNERS))
        for i in range(LED_CORNERS):
            angle = 2.0 * math.pi * i / LED_CORNERS
            # The camera's y is down in Retrolux and up in Blender, its z forward and backward.
            place = (x + corner_m * math.cos(angle), -(y + corner_m * math.sin(angle)), 0.0)
            vertices.append(camera.matrix_world @ Vector(place))
    mesh = bpy.data.meshes.new("ring")
    mesh.from_pydata(vertices, [], [list(face) for face in faces])
    exponent = -math.log(2.0) / math.log(math.cos(math.radians(ring["half_angle_deg"])))
    mesh.materials.append(led_material(exponent, ring["radiant_intensity_w_sr"] / area_m2))
    bpy.context.scene.collection.objects.link(bpy.data.objects.new("ring", mesh))


def empty_material(name):
    material = bpy.data.materials.new(name)
    material.use_nodes = True
    nodes = material.node_tree.nodes
    nodes.clear()
    return material, nodes, material.node_tree.links, nodes.new("ShaderNodeOutputMaterial")


def led_material(exponent, axial_radiance):
    material, nodes, links, output = empty_material("led")

    def math_node(operation, first, second):
        node = nodes.new("ShaderNodeMath")
        node.operation = operation
        for socket, value in zip(node.inputs, (first, second)):
            if isinstance(value, float):
                socket.default_value = value
            else:
                links.new(value, socket)
        return node.outputs[0]

    power = math_node("POWER", view_cosine(nodes, links), exponent - 1.0)
    geometry = nodes.new("ShaderNodeNewGeometry")
    forward = math_node("SUBTRACT", 1.0, geometry.outputs["Backfacing"])
    emission = nodes.new("ShaderNodeEmission")
    links.new(math_node("MULTIPLY", math_node("MULTIPLY", power, axial_radiance), forward),
              emission.inputs["Strength"])
    links.new(emission.outputs[0], output.inputs["Surface"])
    return material


def mask_material(spec):
    """Diffuse as it is; facets and what is below them by colours that depend on the view."""
    material, nodes, links, output = empty_material("mask")
    diffuse = nodes.new("ShaderNodeBsdfDiffuse")
    if spec["type"] == "diffuse":
        diffuse.inputs["Color"].default_value = (spec["reflectance"],) * 3 + (1.0,)
        links.new(diffuse.outputs[0], output.inputs["Surface"])
        return material
    glossy = nodes.new("ShaderNodeBsdfGlossy")
    glossy.distribution = "GGX"
    glossy.inputs["Roughness"].default_value = math.sqrt(spec["roughness"])
    # A table over the square root of the cosine between normal and view, finest at grazing views.
    root = nodes.new("ShaderNodeMath")
    root.operation = "SQRT"
    links.new(view_cosine(nodes, links), root.inputs[0])
    place = nodes.new("ShaderNodeCombineXYZ")
    links.new(root.outputs[0], place.inputs["X"])
    place.inputs["Y"].default_value = 0.5
    cosines = np.maximum(GRAZING, ((np.arange(TABLE_SIZE) + 0.5) / TABLE_SIZE)**2)
    for values, bsdf in zip(facets.retro_colours(spec, cosines), (diffuse, glossy)):
        table = nodes.new("ShaderNodeTexImage")
        table.image = grey_image(values)
        table.interpolation, table.extension = "Linear", "EXTEND"
        links.new(place.outputs[0], table.inputs["Vector"])
        links.new(table.outputs["Color"], bsdf.inputs["Color"])
    both = nodes.new("ShaderNodeAddShader")
    links.new(diffuse.outputs[0], both.inputs[0])
    links.new(glossy.outputs[0], both.inputs[1])
    links.new(both.outputs[0], output.inputs["Surface"])
    return material


def view_cosine(nodes, links):
    """Between the normal and the direction that light leaves in; of either side."""
    geometry = nodes.new("ShaderNodeNewGeometry")
    cosine = nodes.new("ShaderNodeVectorMath")
    cosine.operation = "DOT_PRODUCT"
    links.new(geometry.outputs["Normal"], cosine.inputs[0])
    links.new(geometry.outputs["Incoming"], cosine.inputs[1])
    return cosine.outputs["Value"]


def grey_image(values):
    """A row of linear numbers."""
    image = bpy.data.images.new("table", len(values), 1, float_buffer=True, is_data=True)
    image.pixels = np.stack([values] * 3 + [np.ones_like(values)], axis=1).ravel().tolist()
    return image


def set_cycles(threads, pattern):
    """Nothing that trades bias for speed, and the bounces of the other renderer."""
    scene = bpy.context.scene
    scene.world = None
    scene.render.engine = "CYCLES"
    scene.render.threads_mode, scene.render.threads = "FIXED", threads
    scene.render.use_persistent_data = False
    image = scene.render.image_settings
    image.file_format, image.color_mode, image.color_depth = "OPEN_EXR", "RGB", "32"
    cycles = scene.cycles
    cycles.device = "CPU"
    cycles.sampling_pattern = pattern
    cycles.pixel_filter_type = "BOX"  # one pixel wide
    cycles.use_denoising = False
    cycles.sample_clamp_direct = cycles.sample_clamp_indirect = 0.0
    cycles.light_sampling_threshold = 0.0
    cycles.blur_glossy = 0.0
    cycles.caustics_reflective = cycles.caustics_refractive = True
    cycles.max_bounces = cycles.diffuse_bounces = cycles.glossy_bounces = MAX_SURFACES - 1


def main():
    with open(sys.argv[sys.argv.index("--") + 1]) as file:
        job = json.load(file)
    scene, mask, camera = load(job["scene"])
    spec = scene["cameras"][0]
    set_camera(camera, spec)
    add_ring(camera, spec["ring"])
    material = mask_material(scene["materials"][scene["objects"][0]["material"]])
    mask.data.materials.clear()
    mask.data.materials.append(material)
    set_cycles(job["threads"], job["pattern"])
    render = bpy.context.scene
    for picture in job["pictures"]:
        render.render.filepath = picture["out"]
        render.cycles.samples, render.cycles.seed = picture["spp"], picture["seed"]
        render.cycles.use_adaptive_sampling = "threshold" in picture
        render.cycles.adaptive_threshold = picture.get("threshold", 0.0)
        wall, cpu = time.perf_counter(), sum(os.times()[:2])
        bpy.ops.render.render(write_still=True)
        times = {"wall_s": time.perf_counter() - wall, "cpu_s": sum(os.times()[:2]) - cpu}
        print("picture", json.dumps(times), flush=True)


main()
