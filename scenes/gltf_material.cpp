#include "scenes/gltf_material.h"

#include <limits>

#include "core/error.h"

namespace retrolux {

namespace {

// The object under two keys, the second inside the first.
std::optional<JsonReader> Inside(JsonReader& json, const char* outer, const char* inner) {
  if (!json.Has(outer)) return std::nullopt;
  JsonReader object = json.Child(outer);
  if (!object.Has(inner)) return std::nullopt;
  return object.Child(inner);
}

std::optional<JsonReader> Extension(JsonReader& material, const char* name) {
  return Inside(material, "extensions", name);
}

// Extensions that change the picture, and the value with which they do not.
struct Strength {
  const char* extension;
  const char* key;
  double without_effect;
};

constexpr Strength kNotRead[] = {
    {"KHR_materials_transmission", "transmissionFactor", 0.0},
    {"KHR_materials_diffuse_transmission", "diffuseTransmissionFactor", 0.0},
    {"KHR_materials_clearcoat", "clearcoatFactor", 0.0},
    {"KHR_materials_specular", "specularFactor", 1.0},
};

void RefuseWhatIsNotRead(JsonReader& material) {
  if (material.String("alphaMode", "OPAQUE") != "OPAQUE") {
    material.Child("alphaMode")
        .Fail(material.String("alphaMode"), "OPAQUE, for holes and glass are not read");
  }
  for (const Strength& strength : kNotRead) {
    std::optional<JsonReader> extension = Extension(material, strength.extension);
    if (!extension) continue;
    const double value = extension->Number(strength.key, 0.0, 1.0, strength.without_effect);
    if (value != strength.without_effect) {
      extension->Child(strength.key)
          .Fail(fmt::format("{}", value),
                fmt::format("{}, for the extension is not read", strength.without_effect));
    }
  }
}

void RefuseTexture(JsonReader& json, const char* key) {
  if (json.Has(key)) json.Child(key).Fail("a texture", "factors alone, for it is not read");
}

// Luminance of linear red, green and blue (ITU-R BT.709); alpha has no part in it.
double Luminance(const JsonReader& colour) {
  const std::vector<double> rgba = colour.Numbers(4);
  for (const double x : rgba) {
    if (!(x >= 0.0 && x <= 1.0)) colour.Fail(fmt::format("{}", x), "numbers from 0 to 1");
  }
  return 0.2126 * rgba[0] + 0.7152 * rgba[1] + 0.0722 * rgba[2];
}

// The one material, if there is one, of a node and of those below it.
class MaterialFinder {
 public:
  MaterialFinder(const GltfModel& model, const std::string& place) : model_(model), place_(place) {}

  void Visit(size_t index) {
    const GltfNode& node = model_.nodes[index];
    if (node.mesh) {
      for (const GltfPrimitive& part : model_.meshes[*node.mesh]) Add(part);
    }
    for (const size_t child : node.children) Visit(child);
  }
  size_t Found() const {
    if (!found_) Fail("no material");
    return *found_;
  }
  [[noreturn]] void Fail(std::string_view found) const {
    throw InputError::At(model_.file, place_, found,
                         "one material for all its triangles, or the key 'material' in the scene");
  }

 private:
  void Add(const GltfPrimitive& part) {
    if (!part.material) Fail("triangles without a material");
    if (found_ && found_ != part.material) Fail("several materials");
    found_ = part.material;
  }

  const GltfModel& model_;
  const std::string& place_;
  std::optional<size_t> found_;
};

// As FindMeshNode has it for nodes.
std::string UniqueName(const GltfModel& model, size_t index) {
  const auto name_of = [&](size_t i) {
    JsonReader material = model.materials[i];
    const std::string name = material.String("name", "");
    return name.empty() ? fmt::format("#{}", i) : name;
  };
  const std::string name = name_of(index);
  for (size_t i = 0; i < model.materials.size(); ++i) {
    if (i != index && name_of(i) == name) {
      throw InputError::At(model.file, fmt::format("material '{}'", name),
                           "two materials of that name", "names of their own");
    }
  }
  return name;
}

// Of the base colour, if the material has one.
std::shared_ptr<const Texture> BaseColorTexture(const GltfModel& model, JsonReader material) {
  std::optional<JsonReader> info = Inside(material, "pbrMetallicRoughness", "baseColorTexture");
  if (!info) return nullptr;
  const int texture = info->Integer("index", 0, std::numeric_limits<int>::max());
  if (info->Integer("texCoord", 0, 99, 0) != 0)
    info->Child("texCoord").Fail("another set of coordinates", "0, for no other is read");
  if (Extension(*info, "KHR_texture_transform"))
    info->Fail("KHR_texture_transform", "coordinates as they are, for it is not read");
  const auto known = static_cast<size_t>(texture) < model.textures.size()
                         ? model.textures[static_cast<size_t>(texture)]
                         : std::nullopt;
  if (!known) info->Child("index").Fail(fmt::format("{}", texture), "a texture with an image");
  const GltfImage& image = model.images[*known];
  return std::make_shared<Texture>(model.file.string() + " " + image.name, image.bytes);
}

}  // namespace

GltfSurface ReadGltfSurface(JsonReader material) {
  RefuseWhatIsNotRead(material);
  GltfSurface surface;
  if (material.Has("pbrMetallicRoughness")) {
    JsonReader pbr = material.Child("pbrMetallicRoughness");
    RefuseTexture(pbr, "metallicRoughnessTexture");
    if (pbr.Has("baseColorFactor")) surface.reflectance = Luminance(pbr.Child("baseColorFactor"));
    surface.metallic = pbr.Number("metallicFactor", 0.0, 1.0, surface.metallic);
    surface.roughness = pbr.Number("roughnessFactor", 0.0, 1.0, surface.roughness);
  }
  if (auto extension = Extension(material, "KHR_materials_ior")) {
    surface.ior = extension->Number("ior", 1.0, 4.0, surface.ior);
  }
  if (auto extension = Extension(material, "KHR_materials_retroreflection")) {
    RefuseTexture(*extension, "retroreflectionTexture");
    surface.retroreflection =
        extension->Number("retroreflectionFactor", 0.0, 1.0, surface.retroreflection);
  }
  return surface;
}

Material SharedGltfMaterial(const GltfModel& model, std::span<const size_t> nodes,
                            const std::string& place) {
  MaterialFinder finder(model, place);
  for (const size_t node : nodes) finder.Visit(node);
  const size_t index = finder.Found();
  const std::string name = UniqueName(model, index);
  JsonReader material = model.materials[index];
  if (const auto ours = Inside(material, "extras", "retrolux")) return ReadMaterial(name, *ours);
  const std::string spec = SpecOf(ReadGltfSurface(material)).dump();
  const JsonReader json = JsonReader::FromText(spec, model.file);
  if (auto texture = BaseColorTexture(model, material))
    return TexturedMaterial(name, json, std::move(texture));
  return ReadMaterial(name, json);
}

}  // namespace retrolux
