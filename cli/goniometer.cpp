// retrolux goniometer MATERIAL --out DIR
#include "analysis/goniometer.h"

#include <fmt/format.h>

#include "cli/commands.h"
#include "cli/run_json.h"
#include "core/atomic_file.h"
#include "core/csv.h"
#include "materials/material_library.h"

namespace retrolux::cli {

namespace {

struct GoniometerCommand {
  std::string material;
  std::filesystem::path out;
  GoniometerOptions options;
};

void WriteReadings(const std::vector<GoniometerReading>& readings,
                   const std::filesystem::path& file) {
  CsvWriter csv({"observation_deg", "beta1_deg", "beta2_deg", "entrance_deg", "viewing_deg",
                 "ra_cd_lx_m2", "standard_error_cd_lx_m2"});
  for (const GoniometerReading& r : readings) {
    csv.Row({fmt::format("{:g}", r.observation_deg), fmt::format("{:g}", r.beta1_deg),
             fmt::format("{:g}", r.beta2_deg), fmt::format("{:.4f}", r.entrance_deg),
             fmt::format("{:.4f}", r.viewing_deg), fmt::format("{:.5g}", r.ra),
             fmt::format("{:.2g}", r.standard_error)});
  }
  csv.Write(file);
}

// A row for each observation angle, a column for each entrance angle.
std::string Table(const std::vector<GoniometerReading>& readings,
                  const GoniometerOptions& options) {
  std::string text = "R_A / (cd/(lx m2)), with its standard error\nobservation";
  for (const double beta : options.entrance_deg) {
    text += fmt::format("{:>22}", fmt::format("entrance {:g}", beta));
  }
  for (size_t i = 0; i < options.observation_deg.size(); ++i) {
    text += fmt::format("\n{:>11g}", options.observation_deg[i]);
    for (size_t j = 0; j < options.entrance_deg.size(); ++j) {
      const GoniometerReading& r = readings[i * options.entrance_deg.size() + j];
      text += fmt::format("{:>22}", fmt::format("{:.4g} +- {:.1g}", r.ra, r.standard_error));
    }
  }
  return text;
}

int RunGoniometer(GoniometerCommand command, const GlobalOptions& global) {
  const Material material = NamedOrFile(command.material);
  command.options.seed = global.seed;
  command.options.Check();
  EnsureWritableFolder(command.out);
  const StudyRun run(global);
  const std::vector<GoniometerReading> readings =
      MeasureRetroReflection(material.spec, command.options);
  const std::filesystem::path file = command.out / "goniometer.csv";
  WriteReadings(readings, file);
  run.Write(command.out, {{"readings", readings.size()}});
  nlohmann::json summary = {
      {"material", material.name}, {"file", file.string()}, {"readings", nlohmann::json::array()}};
  for (const GoniometerReading& r : readings) {
    summary["readings"].push_back({{"observation_deg", r.observation_deg},
                                   {"beta1_deg", r.beta1_deg},
                                   {"beta2_deg", r.beta2_deg},
                                   {"entrance_deg", r.entrance_deg},
                                   {"viewing_deg", r.viewing_deg},
                                   {"ra_cd_lx_m2", r.ra},
                                   {"standard_error_cd_lx_m2", r.standard_error}});
  }
  PrintResult(
      global, summary,
      fmt::format("{}: {}\n{}", material.name, Table(readings, command.options), file.string()));
  return kExitGood;
}

}  // namespace

void SetUpGoniometer(CLI::App& app, const GlobalOptions& global, Run& run) {
  auto command = std::make_shared<GoniometerCommand>();
  CLI::App* sub = app.add_subcommand(
      "goniometer",
      "Measure a material's coefficient of retro-reflection as ASTM E810 does, with the renderer "
      "as the instrument: goniometer.csv");
  sub->add_option("MATERIAL", command->material,
                  "of the library (see `retrolux material list`), or a .json file of one")
      ->required();
  sub->add_option("--out", command->out, "folder for the results")->required()->type_name("DIR");
  sub->add_option("--observation", command->options.observation_deg,
                  "observation angles, deg, comma-separated")
      ->delimiter(',')
      ->capture_default_str();
  sub->add_option("--entrance", command->options.entrance_deg,
                  "entrance angles, deg (beta_1 of CIE 54.2), comma-separated")
      ->delimiter(',')
      ->capture_default_str();
  sub->add_option("--beta2", command->options.beta2_deg, "second entrance angle, deg")
      ->capture_default_str();
  sub->add_option("--distance", command->options.distance_mm,
                  "of lamp and receiver from the sheet, mm")
      ->check(CLI::Range(1000.0, 100000.0))
      ->capture_default_str();
  sub->add_option("--samples", command->options.samples, "light paths a reading")
      ->check(CLI::Range(16, 1 << 24))
      ->capture_default_str();
  sub->callback([command, &global, &run] {
    run = [command, &global] { return RunGoniometer(*command, global); };
  });
}

}  // namespace retrolux::cli
