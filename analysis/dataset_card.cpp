#include "analysis/dataset_card.h"

#include "analysis/contact_sheet.h"
#include "analysis/dataset_statistics.h"
#include "analysis/plotly_figure.h"
#include "analysis/report.h"
#include "core/atomic_file.h"

namespace retrolux {

using Json = nlohmann::json;

namespace {

constexpr int kSheetPictures = 24;
constexpr int kSheetColumns = 4;

using Rows = std::vector<std::vector<std::string>>;
struct CardTable {
  std::string caption;
  std::vector<std::string> columns;
  Rows rows;
};

// Of ascending values.
double Quantile(const std::vector<double>& values, double share) {
  return values[static_cast<size_t>(share * static_cast<double>(values.size() - 1) + 0.5)];
}

CardTable SplitTable(const DatasetIndex& index) {
  CardTable table{"Splits, by scene", {"split", "scenes", "pictures", "markers in pictures"}, {}};
  for (const auto& [name, split] : index.header.at("splits").items()) {
    table.rows.push_back(
        {name, split.at("scenes").dump(), split.at("pictures").dump(), split.at("markers").dump()});
  }
  return table;
}

CardTable MarkerTable(const DatasetIndex& index) {
  CardTable table{"Markers of which at least a pixel shows", {"marker", "count"}, {}};
  for (const auto& [name, count] : CountMarkers(index))
    table.rows.push_back({name, std::to_string(count)});
  return table;
}

CardTable NuisanceTable(const DatasetIndex& index) {
  CardTable table{
      "What the scenes were drawn as, by pictures",
      {"nuisance", "pictures that have it", "least / middle / largest, or pictures each"},
      {}};
  for (const NuisanceStatistics& n : CountNuisances(index)) {
    std::vector<std::string> parts;
    if (!n.values.empty()) {
      parts.push_back(fmt::format("{:.4g} / {:.4g} / {:.4g}", n.values.front(),
                                  Quantile(n.values, 0.5), n.values.back()));
    }
    for (const auto& [name, count] : n.counts) parts.push_back(fmt::format("{} {}", name, count));
    table.rows.push_back({n.name, std::to_string(n.pictures), JoinNames(parts)});
  }
  return table;
}

CardTable LabelTable(const DatasetIndex& index) {
  CardTable table{"The markers in the pictures, 0 / 5 / 25 / 50 / 75 / 95 / 100 %",
                  {"figure", "markers", "quantiles"},
                  {}};
  for (const LabelStatistics& figure : CollectLabels(index)) {
    if (figure.values.empty()) continue;
    std::vector<std::string> quantiles;
    for (const double share : {0.0, 0.05, 0.25, 0.5, 0.75, 0.95, 1.0})
      quantiles.push_back(fmt::format("{:.3g}", Quantile(figure.values, share)));
    table.rows.push_back({figure.name, std::to_string(figure.values.size()),
                          fmt::format("{}", fmt::join(quantiles, " / "))});
  }
  return table;
}

std::string Markdown(const CardTable& table) {
  std::string text = "\n## " + table.caption + "\n\n| " +
                     fmt::format("{}", fmt::join(table.columns, " | ")) + " |\n|";
  for (size_t i = 0; i < table.columns.size(); ++i) text += "---|";
  for (const auto& row : table.rows) text += fmt::format("\n| {} |", fmt::join(row, " | "));
  return text + "\n";
}

std::string Head(const DatasetIndex& index, const std::string& command) {
  const Json& h = index.header;
  return fmt::format(
      "# {}\n\n{}\n\n- {} pictures of {} scenes; {} markers in them\n- licence: {}\n- made by "
      "retrolux {}: `{}`\n- seed {}, {} samples per pixel\n- pixel (0, 0) is the centre of the "
      "top-left pixel; lengths mm, angles degrees\n- labels: dataset.json; `retrolux dataset "
      "export` gives COCO, BOP and CSV\n\n![Some of the pictures with their "
      "labels](contact_sheet.png)\n",
      h.at("name").get<std::string>(), h.at("description").get<std::string>(),
      h.at("pictures").get<int>(), index.scenes.size(), h.at("markers").get<int>(),
      h.at("licence").get<std::string>(), h.at("version").get<std::string>(), command,
      h.at("seed").get<uint64_t>(), h.at("spp").get<int>());
}

Json Histogram(const LabelStatistics& figure) {
  return Json::array({{{"type", "histogram"}, {"x", figure.values}, {"nbinsx", 30}}});
}

}  // namespace

void WriteDatasetCard(const DatasetIndex& index, const std::filesystem::path& folder,
                      const std::string& command) {
  const std::string sheet = ContactSheetPng(index, folder, kSheetPictures, kSheetColumns);
  WriteTextFile(folder / "contact_sheet.png", sheet);
  std::string card = Head(index, command);
  Report report("Dataset " + index.header.at("name").get<std::string>(),
                index.header.at("description").get<std::string>());
  report.Picture(
      "Some of the pictures, dark levels raised. Green: pixels that show a marker, and visible "
      "corners; red: hidden corners; cross: radiometric centroid",
      sheet);
  for (const CardTable& table :
       {SplitTable(index), MarkerTable(index), NuisanceTable(index), LabelTable(index)}) {
    card += Markdown(table);
    report.Table(table.caption, table.columns, table.rows);
  }
  for (const LabelStatistics& figure : CollectLabels(index)) {
    report.Plot("Markers over " + figure.name, Histogram(figure),
                {{"xaxis", AxisTitle(figure.name)}, {"yaxis", AxisTitle("markers")}}, 300);
  }
  WriteTextFile(folder / "card.md", card);
  report.Write(folder / "report.html");
}

}  // namespace retrolux
