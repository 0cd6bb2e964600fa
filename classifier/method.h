// The identification methods by name. To add one: declare its function with this signature in a
// header of its own and add a row to the table in method.cpp.
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "classifier/detection.h"
#include "core/marker_set.h"
#include "core/plane.h"

namespace retrolux {

// With the method's default options. `debug` as in IdentifyByEdges.
using Method = std::function<std::vector<Detection>(const DigitalImage&, const MarkerSet&,
                                                    const std::filesystem::path* debug)>;

std::vector<std::string> MethodNames();

// InputError that lists the known names.
Method MethodByName(const std::string& name);

}  // namespace retrolux
