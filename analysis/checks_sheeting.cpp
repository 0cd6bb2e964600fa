// Checks of sheeting by measured tables, on the goniometer.
#include <cmath>

#include "analysis/check.h"
#include "analysis/goniometer.h"
#include "core/data_path.h"
#include "materials/material_library.h"
#include "materials/ra_surface.h"

namespace retrolux {

namespace {

constexpr const char* kSheetings[] = {"retro_bead_table", "retro_high_gain", "retro_prismatic"};

void CheckTablePoints(const std::string& name, const Material& sheeting, const RaTable& table,
                      std::vector<Check>& checks) {
  GoniometerOptions options;
  options.observation_deg = table.observation_deg;
  options.entrance_deg = table.entrance_deg;
  const std::vector<GoniometerReading> readings = MeasureRetroReflection(sheeting.spec, options);
  for (size_t i = 0; i < table.observation_deg.size(); ++i) {
    for (size_t j = 0; j < table.entrance_deg.size(); ++j) {
      const double expected = table.ra[i][j];
      checks.push_back({fmt::format("{}: R_A at {} / {} degrees", name, table.observation_deg[i],
                                    table.entrance_deg[j]),
                        readings[i * table.entrance_deg.size() + j].ra, expected, 0.02 * expected,
                        "cd/(lx m2)",
                        "the published table, R_A = L cos(nu) d^2 / I of a rendered patch: "
                        "independent of it are transport, geometry, sampling and the lamp; the "
                        "BSDF is made from it"});
    }
  }
}

void CheckInterpolation(const std::string& name, const RaTable& table, std::vector<Check>& checks) {
  const auto add = [&](const char* axis, const LeaveOneOut& left_out) {
    checks.push_back({fmt::format("{}: values left out, from their neighbours over the {} angle "
                                  "(rms of ln R_A; largest {:.2f})",
                                  name, axis, left_out.largest),
                      left_out.rms, 0.0, left_out.rms_range, "",
                      "the values left out; half the step between their neighbours, which is what "
                      "no rule of interpolation at all would leave"});
  };
  add("observation", LeaveOneOutObservation(table));
  add("entrance", LeaveOneOutEntrance(table));
}

void CheckExchanged(const std::string& name, const Material& sheeting, std::vector<Check>& checks) {
  GoniometerOptions options;
  options.observation_deg = {0.25, 3.0, 12.0};
  options.entrance_deg = {25.0, 50.0};
  options.beta2_deg = 15.0;
  const std::vector<GoniometerReading> forward = MeasureRetroReflection(sheeting.spec, options);
  options.exchanged = true;
  options.seed = 2;
  const std::vector<GoniometerReading> back = MeasureRetroReflection(sheeting.spec, options);
  for (size_t i = 0; i < forward.size(); ++i) {
    checks.push_back(
        {fmt::format("{}: R_A at {} / {} / {} degrees, lamp and receiver exchanged", name,
                     forward[i].observation_deg, forward[i].beta1_deg, forward[i].beta2_deg),
         back[i].ra, forward[i].ra,
         4.0 * std::hypot(forward[i].standard_error, back[i].standard_error) + 1e-3 * forward[i].ra,
         "cd/(lx m2)",
         "reciprocity, 4 standard errors and 0.1 % for the lamp's size and single "
         "precision"});
  }
}

}  // namespace

std::vector<Check> CheckSheetings() {
  std::vector<Check> checks;
  for (const std::string name : kSheetings) {
    const Material sheeting = LibraryMaterial(name);
    const RaTable table = RaTable::FromFile(DataPath(sheeting.spec.at("table").get<std::string>()));
    CheckTablePoints(name, sheeting, table, checks);
    CheckInterpolation(name, table, checks);
    CheckExchanged(name, sheeting, checks);
  }
  return checks;
}

}  // namespace retrolux
