#include <fmt/format.h>

#include <algorithm>

#include "analysis/hotspot_picture.h"
#include "analysis/hotspot_placement_report.h"
#include "analysis/hotspot_report_plots.h"
#include "analysis/hotspot_report_tables.h"
#include "analysis/room_figure.h"
#include "core/atomic_file.h"

namespace retrolux {

namespace {

// Angles of the strip of pictures.
constexpr double kStrip_deg[] = {2, 5, 10, 15, 20, 30, 40};

std::string SubtitleOf(const HotspotStudy& study) {
  const HotspotSetup& setup = study.series.front().setup;
  const std::string what =
      study.series.front().rows.empty()
          ? "Ring-lit cameras as they stand"
          : fmt::format("Ring-lit cameras at {:g} mm over the angle between them; {} mask",
                        setup.distance_mm, setup.mask);
  return fmt::format("{}; coat of roughness {:g}, {}; retrolux {}", what, setup.roughness,
                     setup.sheeting, RETROLUX_VERSION);
}

class HotspotReport {
 public:
  HotspotReport(const HotspotStudy& study, const std::filesystem::path& folder)
      : study_(study),
        folder_(folder),
        series_(study.series.front()),
        report_("What do neighbouring rings do to a picture?", SubtitleOf(study)) {}

  Report Compose(const std::string& command_line) {
    if (study_.placement) AddHotspotPlacement(*study_.placement, folder_, report_);
    if (!series_.rows.empty()) {
      Summary();
      AddHotspotVerdict(study_, report_);
    }
    if (!study_.room.empty()) Room();
    if (!series_.rows.empty()) {
      Strip();
      AddHotspotPlots(series_, report_);
      Cameras();
    }
    report_.HowMade(command_line);
    report_.Paragraph(fmt::format(
        "Seed {}, noise seed {}. {} exposures of each mix of rings with the default sensor's "
        "noise; one render keeps the rings apart, all mixes follow from it. docs/hotspots.md says "
        "what the figures mean.",
        study_.options.shot.seed, study_.options.shot.noise_seed, study_.options.shot.exposures));
    if (!series_.rows.empty()) Angles();
    return std::move(report_);
  }

 private:
  double RenderNoise() const {
    double largest = 0.0;
    for (const HotspotRow& row : series_.rows) largest = std::max(largest, row.RenderNoise());
    return largest;
  }

  // Cameras and mask of the first placement at some of the angles.
  void Cameras() {
    std::vector<RoomScene> states;
    std::string mask;
    for (const double psi_deg : kStrip_deg) {
      const auto row = std::find_if(series_.rows.begin(), series_.rows.end(),
                                    [&](const HotspotRow& r) { return r.psi_deg == psi_deg; });
      if (row == series_.rows.end()) continue;
      RoomScene& state = states.emplace_back();
      state.label = fmt::format("{:g}°", psi_deg);
      state.scene = HotspotScene(series_.setup, psi_deg, 0, study_.options.shot.seed);
      mask = state.scene.objects.front().name;
      state.numbers = CamerasThatSee(state.scene, mask);
    }
    if (states.empty()) return;
    report_.Room(
        "The cameras with their rings and fields of view, the markers, and the mask coloured by "
        "how many cameras see it.",
        DrawRoom("Angle between cameras", states, mask));
  }

  void Angles() {
    report_.Paragraph(fmt::format(
        "{} placements of the mask at each angle. The paths' scatter on the mask is at most {:.0f} "
        "% of the sensor's noise of one picture. Bars: standard error over placements; 95 % "
        "(Wilson) of rates. All figures are in hotspot.csv, variations.csv, rings.csv, room.csv "
        "and verdict.csv.",
        study_.options.placements, 100.0 * RenderNoise()));
  }

  void Summary() {
    std::vector<KeyFigure> figures;
    for (const HotspotLimit& limit : LimitsOf(series_.rows, study_.Mix("both"))) {
      const std::string name = limit.criterion->name;
      if (name != "highlight" && name != "background" && name != "retro tail" &&
          name != "hits, robust")
        continue;
      figures.push_back({name, LimitText(limit, series_.rows), "", limit.criterion->meaning});
    }
    report_.KeyFigures(figures);
    report_.Paragraph(
        "The thesis forbids pairs of cameras closer than 15 degrees because their diode rings "
        "cause "
        "hot spots, and gives no figure. Here each way in which a neighbour's ring can reach the "
        "picture is looked at by itself: its **highlight** on the mask's coat, the **overlap** of "
        "the two beams on the mask's body, the **tail** of the sheeting's retro-reflection, the "
        "sheeting's own body and cover, the ring in **direct view**, glare, and what saturation "
        "does. The boxes say from which separation on the neighbour changes nothing above three "
        "times the noise of one picture.");
  }

  void Pictures(const std::vector<HotspotPicture>& pictures, const std::string& label,
                std::vector<LabelledPicture>& grid) const {
    for (const HotspotPicture& picture : pictures) {
      grid.push_back(
          {fmt::format("{}: {}", label, picture.kind), ReadTextFile(folder_ / picture.file)});
    }
  }

  void Room() {
    report_.Heading("A real case: " + study_.options.room->name);
    std::vector<LabelledPicture> grid;
    for (const HotspotRoomView& view : study_.room) Pictures(view.pictures, view.camera, grid);
    report_.PictureGrid(
        "What each camera records in the light of its own ring and of all rings (dark levels "
        "raised, gamma 2.2), and the light of all other rings in false colours (e-)",
        grid, 3, NeighboursScale());
    AddHotspotRoomTables(study_.room, study_.Mix("both"), report_);
  }

  void Strip() {
    report_.Heading("Over the angle: own ring, both, the difference");
    std::vector<LabelledPicture> grid;
    for (const double psi_deg : kStrip_deg) {
      for (size_t i = 0; i < series_.rows.size(); ++i) {
        if (series_.rows[i].psi_deg == psi_deg)
          Pictures(series_.pictures[i], fmt::format("{:g}°", psi_deg), grid);
      }
    }
    report_.PictureGrid(
        "Left camera of the pair, one placement of the mask: as recorded in its own ring's light "
        "and in that of both (gamma 2.2), and the neighbour's light in false colours (e-; a "
        "frontal marker in its own ring's light has 21,000)",
        grid, 3, NeighboursScale());
    std::vector<LabelledPicture> variations;
    for (size_t s = 1; s < study_.series.size(); ++s) {
      const HotspotSeries& series = study_.series[s];
      for (size_t i = 0; i < series.rows.size(); ++i) {
        if (series.rows[i].psi_deg == kThesisLimit_deg)
          Pictures(series.pictures[i], series.name, variations);
      }
    }
    if (variations.empty()) return;
    report_.PictureGrid("The same at 15 degrees, with one thing changed", variations, 3,
                        NeighboursScale());
  }

  const HotspotStudy& study_;
  std::filesystem::path folder_;
  const HotspotSeries& series_;
  Report report_;
};

}  // namespace

void WriteHotspotStudyReport(const HotspotStudy& study, const std::filesystem::path& folder,
                             const std::string& command_line) {
  HotspotReport(study, folder).Compose(command_line).Write(folder / "report.html");
}

}  // namespace retrolux
