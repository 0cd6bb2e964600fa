#include "scenes/scene_json_sensor.h"

#include "core/data_path.h"
#include "scenes/scene_json_values.h"

namespace retrolux {

namespace {

const std::vector<std::string>& ScanNames() {  // in the order of Scan
  static const std::vector<std::string> names = {"progressive", "interlaced"};
  return names;
}

// Absent: left as it is; null: none; an object: its values over those that are there.
template <typename Option, typename Read>
void ReadOption(JsonReader& json, const std::string& key, std::optional<Option>& option,
                Read read) {
  if (!json.Has(key)) return;
  if (!HasSome(json, key)) {
    option.reset();
    return;
  }
  JsonReader child = json.Child(key);
  if (!option) option = Option{};
  read(child, *option);
  child.Finish();
}

void ReadBlooming(JsonReader& json, Blooming& blooming) {
  blooming.drained = json.Number("drained", 0.0, 1.0, blooming.drained);
}

void ReadSmear(JsonReader& json, Smear& smear) {
  smear.ratio = json.Number("ratio", 0.0, 1.0, smear.ratio);
  smear.line_time_s = json.Number("line_time_s", 1e-9, 1.0, smear.line_time_s);
}

void ReadDefects(JsonReader& json, DefectPixels& defects) {
  defects.hot_per_million = json.Number("hot_per_million", 0.0, 5e5, defects.hot_per_million);
  defects.hot_dark_current_e_s =
      json.Number("hot_dark_current_e_s", 0.0, 1e9, defects.hot_dark_current_e_s);
  defects.dead_per_million = json.Number("dead_per_million", 0.0, 5e5, defects.dead_per_million);
}

void ReadOver(JsonReader& json, SensorSpec& sensor) {
  sensor.quantum_efficiency = TableName(json, "quantum_efficiency", sensor.quantum_efficiency);
  sensor.full_well_e = json.Number("full_well_e", 1.0, 1e9, sensor.full_well_e);
  sensor.read_noise_e = json.Number("read_noise_e", 0.0, 1e6, sensor.read_noise_e);
  sensor.dark_current_e_s = json.Number("dark_current_e_s", 0.0, 1e9, sensor.dark_current_e_s);
  sensor.adc_bits = json.Integer("adc_bits", 1, 16, sensor.adc_bits);
  sensor.offset_dn = json.Number("offset_dn", 0.0, 65535.0, sensor.offset_dn);
  sensor.gain_dn_e = json.Number("gain_dn_e", 0.0, 65535.0, sensor.gain_dn_e);
  sensor.prnu = json.Number("prnu", 0.0, 0.2, sensor.prnu);
  sensor.dsnu_e = json.Number("dsnu_e", 0.0, 1e6, sensor.dsnu_e);
  sensor.charge_diffusion_um =
      json.Number("charge_diffusion_um", 0.0, 1000.0, sensor.charge_diffusion_um);
  sensor.temperature_c = json.Number("temperature_c", -100.0, 150.0, sensor.temperature_c);
  sensor.dark_reference_c = json.Number("dark_reference_c", -100.0, 150.0, sensor.dark_reference_c);
  sensor.dark_doubling_k = json.Number("dark_doubling_k", 4.0, 100.0, sensor.dark_doubling_k);
  sensor.serial = json.String("serial", sensor.serial);
  if (json.Has("scan")) {
    const std::string scan = json.Choice("scan", ScanNames());
    sensor.scan = scan == ScanNames()[0] ? Scan::kProgressive : Scan::kInterlaced;
  }
  ReadOption(json, "blooming", sensor.blooming, ReadBlooming);
  ReadOption(json, "smear", sensor.smear, ReadSmear);
  ReadOption(json, "defects", sensor.defects, ReadDefects);
}

JsonReader Presets() {
  static const JsonReader file = JsonReader::FromFile(DataPath("scenes/data/sensors.json"));
  JsonReader json = file;
  json.Schema("retrolux/sensors-1");
  JsonReader sensors = json.Child("sensors");
  json.Finish();
  return sensors;
}

}  // namespace

SensorSpec ReadSensor(JsonReader json) {
  SensorSpec sensor;
  if (HasSome(json, "preset")) sensor = SensorPreset(json.Choice("preset", SensorPresetNames()));
  ReadOver(json, sensor);
  json.Finish();
  return sensor;
}

SensorSpec SensorPreset(const std::string& name) {
  JsonReader presets = Presets();
  if (!presets.Has(name)) {
    throw InputError(
        fmt::format("no sensor '{}'; expected one of {}", name, JoinNames(SensorPresetNames())));
  }
  SensorSpec sensor;
  JsonReader json = presets.Child(name);
  ReadOver(json, sensor);
  json.Finish();
  return sensor;
}

std::vector<std::string> SensorPresetNames() {
  return Presets().Keys();
}

std::string ScanName(Scan scan) {
  return ScanNames()[static_cast<size_t>(scan)];
}

}  // namespace retrolux
