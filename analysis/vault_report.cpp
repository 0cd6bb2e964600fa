#include "analysis/vault_report.h"

#include "analysis/mask_picture.h"
#include "analysis/report.h"
#include "analysis/vault_drawing.h"
#include "analysis/vault_plots.h"
#include "analysis/vault_reading.h"
#include "analysis/vault_room.h"
#include "analysis/vault_table.h"
#include "analysis/vault_text.h"
#include "core/atomic_file.h"

namespace retrolux {

namespace {

constexpr int kMaskPicture_px = 420;

std::string Millimetres(double mm) {
  return fmt::format("{:.0f}", mm);
}

class VaultReport {
 public:
  VaultReport(const VaultStudy& study, MaskStores& stores, std::filesystem::path folder)
      : study_(study),
        stores_(stores),
        folder_(std::move(folder)),
        best_(study.best.result),
        report_(
            fmt::format("Where the cameras see the mask best: simulation {}", study.scenario.name),
            fmt::format("{}; {} mask; retrolux " RETROLUX_VERSION, study.scenario.description,
                        fmt::join(study.options.masks, " and "))) {}

  Report Compose(const std::string& command_line) {
    Summary();
    Drawings();
    Costs();
    Orientations();
    Masks();
    Thesis();
    Sensitivity();
    Variations();
    Pictures();
    HowMade(command_line);
    return std::move(report_);
  }

 private:
  const std::string& WorstMaskName() const { return study_.options.masks[best_.WorstMask()]; }

  void Draw(const std::string& caption, const PlotlyFigure& figure) {
    report_.Plot(caption, figure.traces, figure.layout, figure.height_px);
  }
  void Draw(const std::string& caption, const std::optional<PlotlyFigure>& figure) {
    if (figure) Draw(caption, *figure);
  }

  KeyFigure Azimuth() const {
    if (study_.scenario.cameras.arrangement == Arrangement::kEven) {
      return {"From camera to camera", Degrees(360.0 / study_.scenario.cameras.count), "",
              "the first above the horizontal beam"};
    }
    return {"φb, camera 1 beside the beam", Degrees(best_.Where().phi_b_deg), "",
            study_.results.size() == 1 ? "the placement asked for" : "best of all"};
  }

  void Summary() {
    const PlacementWorth& e = best_.Worst();
    const bool counts = e.worth.combination != 0;
    const auto rig = [&](const char* name, double theta_deg) {
      return KeyFigure{name, Degrees(theta_deg), "",
                       fmt::format("{} mm over the floor",
                                   Millimetres(OverFloor_mm(study_.scenario, theta_deg)))};
    };
    report_.KeyFigures(
        {Azimuth(),
         rig("θ₁, rig 1 (even cameras)", best_.Where().theta1_deg),
         rig("θ₂, rig 2 (odd cameras)", best_.Where().theta2_deg),
         {"Cost", fmt::format("{:.3f}", best_.Cost()), "dm²", "in the worst orientation"},
         {"Area seen by two or more", fmt::format("{:.0f}", e.worth.area_mm2 / 100.0), "cm²",
          fmt::format("{:.1f} % of the {} mask",
                      100.0 * e.worth.area_mm2 / study_.mask_area_mm2[best_.WorstMask()],
                      WorstMaskName())},
         {"Reconstruction error", counts ? fmt::format("{:.2f}", e.recon_error_mm) : "–", "mm",
          counts ? fmt::format("by cameras {}, {:.1f}° apart or more", NameOf(e.worth.combination),
                               DegFromRad(e.min_angle_rad))
                 : "no combination counts"}});
    for (const std::string& paragraph : Reading(study_)) report_.Paragraph(paragraph);
  }

  // What needs the mask itself: made once, where a picture first asks for it.
  const PlacementSearch& Search() {
    if (!search_) {
      search_.emplace(study_.scenario, WorstMaskName(),
                      stores_.For(study_.scenario, WorstMaskName()));
    }
    return *search_;
  }
  const MaskRotation& Rotation() const { return WorstRotation(study_, best_); }
  const std::vector<PlacedNozzle>& Nozzles() { return Search().Nozzles(best_.Worst().rotation); }

  void Drawings() {
    report_.Heading("The vault");
    VaultSetup setup{
        study_.scenario, best_.Where(), best_.Worst().worth.combination, Nozzles(), {}};
    for (const Vec3f& position : Search().TheMask().Mesh().positions)
      setup.mask_points.push_back(Rotation().world_from_mask * position.cast<double>());
    Draw(
        fmt::format("The placement to scale, for the orientation of the {} mask that decides ({}). "
                    "Cameras with a black edge are the combination that sees it best; cameras that "
                    "one point of the drawing stands for share a label.",
                    WorstMaskName(), TextOf(Rotation())),
        DrawVault(setup));
    report_.Room(
        "The same in three dimensions: cameras with their rings and fields of view, the nozzles, "
        "and the mask coloured by how many cameras see it.",
        DrawVaultRoom(study_));
  }

  void Costs() {
    const auto heights = CostOverHeights(study_);
    const auto phi_b = CostOverPhiB(study_);
    if (!heights && !phi_b) return;
    report_.Heading("Cost of all placements");
    report_.Paragraph(
        "The cost is that of a placement's worst orientation, seen by the combination of cameras "
        "that is best for it: the area that two or more of them see, weighted by how well they "
        "reconstruct a point, in dm² (10⁴ mm², the thesis's unit). More is better.");
    Draw("Best cost of each φb over all heights of the rigs (thesis figures 4.25 to 4.31)", phi_b);
    Draw(study_.scenario.rigs.same_height
             ? "Cost over the height of the cameras for each φb of phase 1"
             : "Cost over the heights of both rigs for each φb of phase 1 (the thesis's height "
               "maps), one scale of colours. White: can't be built. Marks lie in the map with the "
               "nearest φb.",
         heights);
  }

  void Orientations() {
    std::vector<CostCurve> curves;
    const auto add = [&](const NamedResult& named, const std::string& name, const char* colour) {
      for (size_t mask = 0; mask < named.orientations.size(); ++mask) {
        const bool deciding = mask == best_.WorstMask();
        curves.push_back({named.orientations.size() < 2
                              ? name
                              : fmt::format("{}, {}", name, study_.options.masks[mask]),
                          CostsOf(named.orientations[mask]), colour, deciding ? "solid" : "dot"});
      }
    };
    add(study_.best, study_.options.placement ? "best here" : "optimum", plot_colour::kBlue);
    if (study_.runner_up) add(*study_.runner_up, "runner-up", plot_colour::kOrange);
    const char* colours[] = {plot_colour::kPurple, plot_colour::kGreen, plot_colour::kBlack};
    for (size_t i = 0; i < study_.thesis.size(); ++i)
      add(study_.thesis[i], "thesis's " + study_.thesis[i].name, colours[i % std::size(colours)]);
    if (curves.empty()) return;
    report_.Heading("Cost of all orientations");
    Draw(
        "Costs of all orientations, sorted (thesis figure 4.32). The left end is what the search "
        "compares.",
        SortedCosts(curves));
    Draw(study_.runner_up
             ? fmt::format("Optimum and runner-up ({}) at each orientation of the {} mask (thesis "
                           "figure 4.29)",
                           TextOf(study_.runner_up->result.Where()), WorstMaskName())
             : "",
         OptimumAgainstRunnerUp(study_));
  }

  void Masks() {
    const auto figure = MasksCompared(study_);
    if (!figure) return;
    report_.Heading("Which mask decides");
    std::string text;
    for (size_t mask = 0; mask < study_.options.masks.size(); ++mask) {
      const auto decides =
          std::count_if(study_.results.begin(), study_.results.end(),
                        [&](const PlacementResult& r) { return r.WorstMask() == mask; });
      text += fmt::format("{} **{}** mask at {} of {} placements",
                          text.empty() ? "The worst orientation is one of the" : ", of the",
                          study_.options.masks[mask], decides, study_.results.size());
    }
    report_.Paragraph(text + ".");
    Draw("Cost of each mask at every placement (thesis figure 4.24)", figure);
  }

  void Thesis() {
    if (study_.thesis.empty()) return;
    report_.Heading("The thesis beside ours");
    std::vector<std::string> printed;
    report_.Table(
        "Table 4.9 of the thesis: as printed, the same placement with our program, and "
        "our optimum",
        SolutionColumns(), SolutionRows(study_, printed));
    report_.Paragraph(kSolutionNote + SolutionRemarks(study_));
  }

  std::vector<std::string> PlaceRow(const std::string& name, const Placement& p,
                                    double cost) const {
    const double best = best_.Cost();
    return {name,
            fmt::format("{:.4g}", p.phi_b_deg),
            fmt::format("{:.2f}", p.theta1_deg),
            fmt::format("{:.2f}", p.theta2_deg),
            Millimetres(OverFloor_mm(study_.scenario, p.theta1_deg)),
            Millimetres(OverFloor_mm(study_.scenario, p.theta2_deg)),
            fmt::format("{:.4f}", cost),
            fmt::format("{:+.4f}", cost - best),
            SignedPercent(cost / best - 1.0)};
  }

  void Sensitivity() {
    if (study_.sensitivity.empty() && !study_.snapped && !study_.refined) return;
    report_.Heading("Around the optimum");
    Draw(
        "What it costs to move one variable of the optimum to either side, and by how much that "
        "moves its rig. A missing bar can't be built.",
        SensitivityBars(study_));
    std::vector<std::vector<std::string>> rows = {PlaceRow("optimum", best_.Where(), best_.Cost())};
    if (study_.snapped) {
      rows.push_back(PlaceRow(
          fmt::format("rounded to {:g}° and {:g} mm", study_.scenario.search.snap_phi_b_deg,
                      study_.scenario.search.snap_height_mm),
          study_.snapped->result.Where(), study_.snapped->result.Cost()));
    }
    if (study_.refined)
      rows.push_back(PlaceRow("between the grid", study_.refined->placement, study_.refined->cost));
    for (const NamedResult& moved : study_.sensitivity)
      rows.push_back(PlaceRow(moved.name, moved.result.Where(), moved.result.Cost()));
    report_.Table("Placements around the optimum; heights over the floor",
                  {"placement", "φb / °", "θ₁ / °", "θ₂ / °", "rig 1 / mm", "rig 2 / mm", "cost",
                   "change", "change / %"},
                  rows);
  }

  void Variations() {
    if (study_.variations.empty()) return;
    report_.Heading("What the answer hangs on");
    report_.Paragraph(
        "The search of phase 1 repeated under changes of what nobody knows well. Our optimum is "
        "taken to the nearest point of that grid there, so that the two are comparable.");
    Draw(
        "Cost of the best placement under each variation and of our optimum; dotted: the "
        "optimum's cost without a variation",
        VariationLines(study_));
    std::vector<std::vector<std::string>> bands;
    for (const Band& band : BandsOf(study_)) {
      const int decimals = band.unit.empty() ? 3 : 2;
      bands.push_back({band.unit.empty() ? band.name : fmt::format("{} / {}", band.name, band.unit),
                       fmt::format("{:.{}f}", band.ours, decimals),
                       fmt::format("{:.{}f}", band.least, decimals),
                       fmt::format("{:.{}f}", band.greatest, decimals)});
    }
    report_.Table("How far the optimum moves over all variations",
                  {"", "our optimum", "least", "greatest"}, bands);
    std::vector<std::vector<std::string>> rows;
    for (const VariedOptimum& v : study_.variations) {
      rows.push_back({v.name, fmt::format("{:g}", v.best.Where().phi_b_deg),
                      fmt::format("{:.2f}", v.best.Where().theta1_deg),
                      fmt::format("{:.2f}", v.best.Where().theta2_deg),
                      fmt::format("{:.4f}", v.best.Cost()), fmt::format("{:.4f}", v.cost_of_ours),
                      SignedPercent(v.cost_of_ours / v.best.Cost() - 1.0)});
    }
    report_.Table(
        "Best placement under each variation",
        {"variation", "φb / °", "θ₁ / °", "θ₂ / °", "cost", "our optimum there", "loss / %"}, rows);
  }

  void Pictures() {
    report_.Heading("What the cameras see");
    const Mask& mask = Search().TheMask();
    const int cameras = study_.scenario.cameras.count;
    std::vector<SampleSet> all, chosen;
    for (int camera = 0; camera < cameras; ++camera) {
      all.push_back(Search().SeenBy(best_.Where(), camera, best_.Worst().rotation));
      if (((best_.Worst().worth.combination >> camera) & 1u) != 0) chosen.push_back(all.back());
    }
    const MaskPainter painter(mask.Mesh());
    CountPictures(painter, mask, all, "all cameras");
    if (!chosen.empty()) {
      CountPictures(painter, mask, chosen,
                    "the combination " + NameOf(best_.Worst().worth.combination));
    }
    CameraPictures(painter, mask, all);
  }

  void CountPictures(const MaskPainter& painter, const Mask& mask,
                     const std::vector<SampleSet>& sets, const std::string& whose) {
    const std::vector<int> counts =
        CamerasPerTriangle(mask.Samples(), mask.Mesh().triangles.size(), sets);
    const std::vector<OvalCategory> colours = CountCategories(static_cast<int>(sets.size()));
    std::vector<LabelledPicture> pictures;
    for (const Viewpoint& view : ViewpointsOf(mask.Mesh(), kMaskPicture_px, kMaskPicture_px)) {
      pictures.push_back({view.name, painter.Counts(counts, colours, view.camera).Png()});
    }
    report_.PictureGrid(
        fmt::format(
            "The {} mask in its worst orientation ({}), each triangle by how many of **{}** "
            "see the larger part of it; seen from the mask's own front and sides, grey its "
            "inner side. A point can be located where two or more see it.",
            mask.Name(), TextOf(Rotation()), whose),
        pictures, 3, colours);
  }

  void CameraPictures(const MaskPainter& painter, const Mask& mask,
                      const std::vector<SampleSet>& seen) {
    const std::vector<Vec3d> centres = CameraCentres(study_.scenario, best_.Where());
    std::vector<LabelledPicture> pictures;
    for (size_t i = 0; i < centres.size(); ++i) {
      const CameraModel camera = VaultCamera(study_.scenario, "", centres[i]);
      const bool chosen = ((best_.Worst().worth.combination >> i) & 1u) != 0;
      pictures.push_back(
          {fmt::format("camera {}{}: sees {:.0f} cm²", i + 1, chosen ? " (of the combination)" : "",
                       mask.AreaOf(seen[i]) / 100.0),
           painter.Ids(camera, Rotation().world_from_mask, Nozzles()).Png()});
    }
    report_.PictureGrid(
        "What each camera has before it in that orientation: the triangles of the "
        "mask, each in a colour of its own, and the nozzles, hatched (snout "
        "lighter, cylinder darker)",
        pictures, 3);
  }

  void HowMade(const std::string& command_line) {
    report_.HowMade(command_line);
    const VaultStudy::Rates& rates = study_.rates;
    const Mask& mask = Search().TheMask();
    report_.Paragraph(fmt::format(
        "Visibility rule `{}`; {} samples on {} triangles of the {} mask. In this run {} "
        "placements "
        "and {} orientations of them in {:.1f} s, {} views made for {} that were asked for; {} "
        "tasks, {} of them from before.",
        NameOf(mask.Rule()), mask.Samples().Size(), mask.Mesh().triangles.size(), mask.Name(),
        rates.placements, rates.orientations, rates.seconds, rates.buffers_made,
        rates.buffers_asked, study_.tasks.done_before + study_.tasks.done_now,
        study_.tasks.done_before));
    std::vector<std::string> files = {"evaluations.csv"};
    if (study_.options.masks.size() > 1) {
      for (const std::string& name : study_.options.masks)
        files.push_back(fmt::format("evaluations_{}.csv", name));
    }
    files.insert(files.end(), {"orientations.csv", "solution.json"});
    for (const std::string& file : files) {
      if (std::filesystem::exists(folder_ / file))
        report_.Attachment(file, ReadTextFile(folder_ / file));
    }
  }

  const VaultStudy& study_;
  MaskStores& stores_;
  std::filesystem::path folder_;
  const PlacementResult& best_;
  std::optional<PlacementSearch> search_;
  Report report_;
};

}  // namespace

void WriteVaultReport(const VaultStudy& study, MaskStores& stores,
                      const std::filesystem::path& folder, const std::string& command_line) {
  VaultReport(study, stores, folder).Compose(command_line).Write(folder / "report.html");
}

}  // namespace retrolux
