// retrolux material list | show MATERIAL | fit TABLE.csv
#include <fmt/format.h>

#include <cmath>

#include "analysis/lobe_fit.h"
#include "cli/commands.h"
#include "materials/material_library.h"

namespace retrolux::cli {

namespace {

struct FitCommand {
  std::filesystem::path table;
  int lobes = 2;
  std::string distribution = "ggx";
};

int RunList(const GlobalOptions& global) {
  nlohmann::json summary = {{"materials", nlohmann::json::array()}};
  std::string text;
  for (const std::string& name : LibraryMaterialNames()) {
    const nlohmann::json spec = LibraryMaterial(name).spec;
    const std::string type = spec.at("type").get<std::string>();
    const std::string comment = spec.value("comment", "");
    summary["materials"].push_back({{"name", name}, {"type", type}, {"comment", comment}});
    text += fmt::format("{}{:<17} {:<15} {}", text.empty() ? "" : "\n", name, type, comment);
  }
  PrintResult(global, summary, text);
  return kExitGood;
}

int RunShow(const GlobalOptions& global, const std::string& name) {
  const Material material = NamedOrFile(name);
  PrintResult(global, {{"name", material.name}, {"material", material.spec}},
              material.spec.dump(2));
  return kExitGood;
}

nlohmann::json LobesJson(const LobeFit& fit, const std::string& distribution) {
  nlohmann::json lobes = nlohmann::json::array();
  for (const RetroLobe& lobe : fit.lobes) {
    lobes.push_back({{"roughness", lobe.facets.alpha},
                     {"albedo", lobe.albedo},
                     {"distribution", distribution}});
  }
  return lobes;
}

std::string Text(const LobeFit& fit, const RaTable& table) {
  std::string text;
  for (const RetroLobe& lobe : fit.lobes) {
    text += fmt::format("lobe: roughness {:.5f}, albedo {:.4f}\n", lobe.facets.alpha, lobe.albedo);
  }
  for (size_t j = 0; j < table.entrance_deg.size(); ++j) {
    text += fmt::format("entrance {:g} deg: weight {:.4f}\n", table.entrance_deg[j],
                        fit.entrance_weight[j]);
  }
  text += "observation/deg  entrance/deg  R_A/(cd/(lx m2))      fit  ln(fit/table)\n";
  for (size_t i = 0; i < table.observation_deg.size(); ++i) {
    for (size_t j = 0; j < table.entrance_deg.size(); ++j) {
      text += fmt::format("{:>15g} {:>13g} {:>17g} {:>8.4g} {:>+14.3f}\n", table.observation_deg[i],
                          table.entrance_deg[j], table.ra[i][j],
                          table.ra[i][j] * std::exp(fit.residuals[i][j]), fit.residuals[i][j]);
    }
  }
  return text + fmt::format("rms of ln R_A: {:.3f}", fit.rms_ln_ra);
}

int RunFit(const GlobalOptions& global, const FitCommand& command) {
  const RaTable table = RaTable::FromFile(command.table);
  const FacetShape shape = command.distribution == "ggx" ? FacetShape::kGgx : FacetShape::kBeckmann;
  const LobeFit fit = FitLobes(table, command.lobes, shape);
  PrintResult(global,
              {{"table", command.table.string()},
               {"lobes", LobesJson(fit, command.distribution)},
               {"observation_deg", table.observation_deg},
               {"entrance_deg", table.entrance_deg},
               {"entrance_weight", fit.entrance_weight},
               {"rms_ln_ra", fit.rms_ln_ra},
               {"residuals_ln_ra", fit.residuals}},
              Text(fit, table));
  return kExitGood;
}

void SetUpFit(CLI::App& material, const GlobalOptions& global, Run& run) {
  auto command = std::make_shared<FitCommand>();
  CLI::App* fit = material.add_subcommand(
      "fit", "Lobes of the back-vector model (type retroreflector) nearest to a measured table");
  fit->add_option("TABLE", command->table, "a CSV of observation_deg,entrance_deg,ra_cd_lx_m2")
      ->required();
  fit->add_option("--lobes", command->lobes, "how many")
      ->check(CLI::Range(1, 4))
      ->capture_default_str();
  fit->add_option("--distribution", command->distribution, "of the facets: ggx or beckmann")
      ->check(CLI::IsMember({"ggx", "beckmann"}))
      ->capture_default_str();
  fit->callback(
      [command, &global, &run] { run = [command, &global] { return RunFit(global, *command); }; });
}

}  // namespace

void SetUpMaterial(CLI::App& app, const GlobalOptions& global, Run& run) {
  CLI::App* material = app.add_subcommand("material", "List, describe or fit materials");
  CLI::App* list = material->add_subcommand("list", "The materials of the library");
  list->callback([&global, &run] { run = [&global] { return RunList(global); }; });
  auto name = std::make_shared<std::string>();
  CLI::App* show = material->add_subcommand("show", "The parameters of a material");
  show->add_option("MATERIAL", *name, "of the library, or a .json file of one")->required();
  show->callback(
      [name, &global, &run] { run = [name, &global] { return RunShow(global, *name); }; });
  SetUpFit(*material, global, run);
}

}  // namespace retrolux::cli
