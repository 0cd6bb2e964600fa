#include "classifier/method.h"

#include "classifier/edges.h"
#include "classifier/robust.h"
#include "classifier/tags.h"
#include "core/error.h"

namespace retrolux {

namespace {

struct Entry {
  std::string name;
  Method method;
};

// The libraries' methods are named as the families of tags that they find.
void AddTagMethods(std::vector<Entry>& methods) {
  for (const TagFamily& family : TagFamilies()) {
    methods.push_back({family.name, [&family](const DigitalImage& image, const MarkerSet& markers,
                                              const std::filesystem::path* debug) {
                         return IdentifyTags(family, image, markers, debug);
                       }});
  }
}

std::vector<Entry> MakeMethods() {
  std::vector<Entry> methods = {
      {"edges",
       [](const DigitalImage& image, const MarkerSet& markers, const std::filesystem::path* debug) {
         return IdentifyByEdges(image, markers, EdgesOptions{}, debug);
       }},
      {"robust",
       [](const DigitalImage& image, const MarkerSet& markers, const std::filesystem::path* debug) {
         return IdentifyRobustly(image, markers, RobustOptions{}, debug);
       }},
  };
  AddTagMethods(methods);
  return methods;
}

const std::vector<Entry>& Methods() {
  static const std::vector<Entry> methods = MakeMethods();
  return methods;
}

}  // namespace

std::vector<std::string> MethodNames() {
  std::vector<std::string> names;
  for (const Entry& entry : Methods()) names.push_back(entry.name);
  return names;
}

Method MethodByName(const std::string& name) {
  for (const Entry& entry : Methods()) {
    if (name == entry.name) return entry.method;
  }
  throw InputError(
      fmt::format("no method '{}'; expected one of {}", name, JoinNames(MethodNames())));
}

}  // namespace retrolux
