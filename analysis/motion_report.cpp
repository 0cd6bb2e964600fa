#include <fmt/format.h>

#include <cmath>
#include <limits>

#include "analysis/area_plots.h"
#include "analysis/motion_study.h"
#include "analysis/report.h"
#include "core/atomic_file.h"

namespace retrolux {

namespace {

using nlohmann::json;
using namespace plot_colour;

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

class MotionReport {
 public:
  explicit MotionReport(const MotionStudy& study)
      : study_(study),
        report_("A patient who breathes, drifts and coughs",
                fmt::format("Two cameras {:g}° apart, {} frames at {:g} a second; retrolux {}",
                            study.options.psi_deg, study.options.frames, study.options.frames_per_s,
                            RETROLUX_VERSION)) {}

  Report Compose(const std::filesystem::path& folder, const std::string& command_line) {
    Summary();
    Displacement();
    Alarm();
    Hidden();
    Pictures(folder);
    report_.HowMade(command_line);
    report_.Paragraph(fmt::format(
        "Seed {}. Every frame is rendered and exposed at one instant, with its own noise, and "
        "identified; a tracker for each camera gives the names, and the mask's pose follows from "
        "all markers that both cameras see. What the motion is made of, and from where: "
        "docs/stereo.md. All figures are in motion.csv.",
        study_.options.shot.seed));
    return std::move(report_);
  }

 private:
  double Latency_ms() const { return 1e3 * (study_.alarm_s - study_.crossing_s); }
  bool Crossed() const { return study_.alarm_s >= 0.0 && study_.crossing_s >= 0.0; }

  void Summary() {
    std::vector<KeyFigure> figures = {
        {"Error", fmt::format("{:.3f}", study_.rms_error_mm), "mm",
         fmt::format("rms of the displacement; greatest {:.3f}", study_.max_error_mm)}};
    if (Crossed()) {
      figures.push_back(
          {"Latency", fmt::format("{:.0f}", Latency_ms()), "ms",
           fmt::format("from the limit to the frame of the alarm; a frame lasts {:.0f}",
                       1e3 / study_.options.frames_per_s)});
    }
    figures.push_back(
        {"Wrong alarms", std::to_string(study_.false_alarms), "frames",
         fmt::format("and {} frames without one that should have had it", study_.missed_alarms)});
    report_.KeyFigures(figures);
  }

  std::vector<double> Times() const {
    std::vector<double> times;
    for (const MotionFrame& frame : study_.frames) times.push_back(frame.time_s);
    return times;
  }

  void Draw(const std::string& caption, const std::vector<PlotCurve>& curves,
            const std::string& y_title) {
    const PlotlyFigure figure = FigureOf(curves, AxisTitle("time (s)"), AxisTitle(y_title));
    report_.Plot(caption, figure.traces, figure.layout, figure.height_px);
  }

  void Displacement() {
    report_.Heading("Displacement at the isocentre");
    const char* names[] = {"x", "y", "z"};
    const char* colours[] = {kBlue, kVermillion, kGreen};
    std::vector<PlotCurve> curves;
    for (Eigen::Index axis = 0; axis < 3; ++axis) {
      PlotCurve truth{fmt::format("true {}", names[axis]), Times(), {}, colours[axis], "lines"};
      PlotCurve found{fmt::format("found {}", names[axis]), Times(), {}, colours[axis], "markers"};
      for (const MotionFrame& frame : study_.frames) {
        truth.y.push_back(frame.true_mm[axis]);
        found.y.push_back(frame.found_mm ? (*frame.found_mm)[axis] : kNone);
      }
      curves.push_back(std::move(truth));
      curves.push_back(std::move(found));
    }
    Draw("Displacement of the mask's origin, true and found", curves, "mm");
    PlotCurve error{"error", Times(), {}, kBlack};
    PlotCurve markers{"markers behind the pose", Times(), {}, kSky, "lines"};
    for (const MotionFrame& frame : study_.frames) {
      error.y.push_back(frame.found_mm ? 1e3 * (*frame.found_mm - frame.true_mm).norm() : kNone);
      markers.y.push_back(frame.markers);
    }
    Draw("Error of the displacement", {error}, "μm");
    Draw("Markers that both cameras saw", {markers}, "markers");
  }

  void Alarm() {
    report_.Heading("The alarm");
    const double limit = study_.options.limit_mm;
    PlotCurve truth{"true", Times(), {}, kBlack, "lines"};
    PlotCurve quiet{"found", Times(), {}, kBlue, "markers"};
    PlotCurve loud{"found, alarm", Times(), {}, kVermillion, "markers"};
    for (const MotionFrame& frame : study_.frames) {
      truth.y.push_back(frame.true_mm.norm());
      const double found = frame.found_mm ? frame.found_mm->norm() : kNone;
      quiet.y.push_back(frame.alarm ? kNone : found);
      loud.y.push_back(frame.alarm ? found : kNone);
    }
    const double end_s = study_.frames.back().time_s;
    const PlotCurve line{"limit", {0.0, end_s}, {limit, limit}, kGrey, "lines", "dash"};
    Draw("Length of the displacement and the limit", {truth, quiet, loud, line}, "mm");
    if (!Crossed()) {
      report_.Paragraph("The limit was not passed.");
      return;
    }
    report_.Paragraph(fmt::format(
        "The truth passes {:g} mm at {:.3f} s, the first frame with an alarm is that of {:.3f} s: "
        "**{:.0f} ms** or {:.1f} frames later, of which waiting for the next frame is all but what "
        "the error of the place adds. Identification took {:.1f} ms of one core a picture. What a "
        "camera adds, its exposure and the transfer of the "
        "picture, is not in it.",
        limit, study_.crossing_s, study_.alarm_s, Latency_ms(),
        1e-3 * Latency_ms() * study_.options.frames_per_s, study_.identify_ms));
  }

  void Hidden() {
    report_.Heading("Markers that are hidden");
    std::vector<std::vector<std::string>> rows;
    for (const HiddenOutcome& outcome : study_.outcomes) {
      rows.push_back(
          {std::to_string(outcome.hidden.number),
           fmt::format("{} to {}", outcome.hidden.first, outcome.hidden.last),
           outcome.lost ? "lost" : "missed",
           outcome.back_after_frames < 0 ? "never" : std::to_string(outcome.back_after_frames),
           outcome.by_name ? "by identification" : "by its expected place"});
    }
    report_.Table(
        fmt::format(
            "Hidden from the left camera by a plate. Lost: after more than {} frames. Back: "
            "frames after the first in which it was free",
            study_.options.tracking.max_missed),
        {"marker", "frames", "then", "back after", "how"}, rows);
    // One trace: on a shared axis of names plotly would look for the rows of both in each.
    json z = json::array(), y = json::array();
    const size_t markers = study_.frames.front().states[0].size();
    for (size_t camera = 0; camera < 2; ++camera) {
      for (size_t m = 0; m < markers; ++m) {
        json row = json::array();
        for (const MotionFrame& frame : study_.frames)
          row.push_back(static_cast<int>(frame.states[camera][m]));
        z.push_back(row);
        y.push_back(fmt::format("{} {}", camera == 0 ? "left" : "right", m + 1));
      }
    }
    const json states = {
        {"type", "heatmap"},
        {"x", Times()},
        {"y", y},
        {"z", z},
        {"zmin", 0},
        {"zmax", 3},
        {"colorbar",
         {{"tickvals", {0, 1, 2, 3}}, {"ticktext", {"unseen", "tracked", "missed", "lost"}}}}};
    report_.Plot("State of each marker in each camera", json::array({states}),
                 {{"xaxis", AxisTitle("time (s)")}, {"yaxis", AxisTitle("camera and marker")}},
                 460);
    int followed = 0;
    for (const MotionFrame& frame : study_.frames) followed += frame.followed_without_name;
    report_.Paragraph(fmt::format(
        "Sightings that tracking kept although identification gave no name: **{}**.", followed));
  }

  void Pictures(const std::filesystem::path& folder) {
    report_.Heading("Frames");
    std::vector<LabelledPicture> pictures;
    for (const std::string& picture : study_.pictures) {
      const std::filesystem::path file = folder / picture;
      pictures.push_back({file.stem().string(), ReadTextFile(file)});
    }
    report_.PictureGrid("As the cameras gave them", pictures, 4);
  }

  const MotionStudy& study_;
  Report report_;
};

}  // namespace

void WriteMotionReport(const MotionStudy& study, const std::filesystem::path& folder,
                       const std::string& command_line) {
  MotionReport(study).Compose(folder, command_line).Write(folder / "report.html");
}

}  // namespace retrolux
