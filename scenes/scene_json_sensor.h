// The sensor of a camera in a scene file, and the parts that it can begin with:
// scenes/data/sensors.json.
#pragma once

#include "core/json_reader.h"
#include "scenes/scene.h"

namespace retrolux {

// "sensor": {parameters}, or {"preset": NAME, parameters that differ from it}.
SensorSpec ReadSensor(JsonReader json);

// A part of the library; InputError that lists the known names.
SensorSpec SensorPreset(const std::string& name);
std::vector<std::string> SensorPresetNames();

// As scene files call them.
std::string ScanName(Scan scan);

}  // namespace retrolux
