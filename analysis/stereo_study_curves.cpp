#include "analysis/stereo_study_curves.h"

#include <fmt/format.h>

#include <cmath>
#include <limits>

#include "analysis/area_plots.h"
#include "analysis/reconstruction_error.h"

namespace retrolux {

namespace {

using nlohmann::json;
using namespace plot_colour;

// Where the thesis's curve and ours are made to meet.
constexpr double kCommon_deg = 45.0;

const char* WordsFor(StereoTarget target) {
  return target == StereoTarget::kPanel ? "flat black panel" : "oval mask";
}

// A curve over the separation, with the 95 % interval of the rms where it is one.
json Trace(const PlotCurve& curve, const std::vector<double>& above = {},
           const std::vector<double>& below = {}) {
  json trace = FigureOf({curve}, json::object(), json::object()).traces.front();
  if (!above.empty())
    trace["error_y"] = {{"symmetric", false}, {"array", above}, {"arrayminus", below}};
  return trace;
}

json LogY(const std::string& title) {
  json axis = LogAxisTitle(title);
  axis["dtick"] = "D2";
  return axis;
}

class ErrorCurves {
 public:
  ErrorCurves(const StereoStudy& study, Report& report)
      : study_(study),
        scenario_(LoadScenario("1a")),
        thesis_(scenario_.error_points, scenario_.gamma_max_mm),
        report_(report) {}

  void Add() {
    for (const StereoTarget target : study_.options.targets) OverAngle(target);
    BesideTheThesis();
    FoundShare();
  }

 private:
  void Draw(const std::string& caption, json traces, json y_axis) {
    json x_axis = AxisTitle("separation of the cameras ψ (degrees)");
    x_axis["dtick"] = 15;
    report_.Plot(caption, std::move(traces), {{"xaxis", x_axis}, {"yaxis", std::move(y_axis)}},
                 460);
  }

  static void Append(PlotCurve& curve, double x, double y) {
    curve.x.push_back(x);
    curve.y.push_back(y > 0.0 ? y : std::numeric_limits<double>::quiet_NaN());
  }

  void OverAngle(StereoTarget target) {
    report_.Heading(fmt::format("Error over the angle: {}", WordsFor(target)));
    json traces = json::array();
    PlotCurve noise_depth{"noise, depth", {}, {}, kBlue, "markers", "solid", "square-open"};
    PlotCurve noise_across{"noise, across", {}, {}, kVermillion, "markers", "solid", "square-open"};
    PlotCurve model_depth{"two rays, depth", {}, {}, kBlue, "lines", "dot"};
    PlotCurve model_across{"two rays, across", {}, {}, kVermillion, "lines", "dot"};
    for (const MarkerPoint point : {MarkerPoint::kCentre, MarkerPoint::kLight}) {
      const bool centre = point == MarkerPoint::kCentre;
      PlotCurve rms{
          centre ? "rms, fitted middle" : "rms, centroid", {}, {}, centre ? kBlack : kGrey};
      std::vector<double> above, below;
      for (const StereoRow* row : study_.Rows(target, point)) {
        if (row->error.found == 0) continue;
        Append(rms, row->psi_deg, row->error.rms);
        above.push_back(row->error.rms_high - row->error.rms);
        below.push_back(row->error.rms - row->error.rms_low);
        if (!centre) continue;
        Append(noise_depth, row->psi_deg, row->error.noise.x());
        Append(noise_across, row->psi_deg, row->error.noise.y());
        const Vec3d model = RaySigma_mm(row->error.noise_px * study_.mm_per_px, row->psi_deg);
        Append(model_depth, row->psi_deg, model.x());
        Append(model_across, row->psi_deg, model.y());
      }
      traces.push_back(Trace(rms, above, below));
    }
    for (const PlotCurve& curve : {noise_depth, noise_across, model_depth, model_across})
      traces.push_back(Trace(curve));
    Draw(fmt::format("{}: rms error with its 95 % interval; noise (1 sigma over exposures, fitted "
                     "middle) beside that of two rays with the noise measured in the pictures",
                     WordsFor(target)),
         traces, LogY("mm"));
    ErrorTable(target);
  }

  void ErrorTable(StereoTarget target) {
    std::vector<std::vector<std::string>> rows;
    for (const StereoRow& row : study_.rows) {
      if (row.target != target) continue;
      const SpatialError& e = row.error;
      const bool none = e.found == 0;
      const auto cell = [&](double v) { return none ? "" : fmt::format("{:.4f}", v); };
      rows.push_back({fmt::format("{:g}", row.psi_deg),
                      row.point == MarkerPoint::kCentre ? "fitted middle" : "centroid",
                      fmt::format("{} of {}", e.found, e.expected),
                      fmt::format("{:.1f}", row.incidence_deg), cell(e.rms),
                      none ? "" : fmt::format("{:.4f} to {:.4f}", e.rms_low, e.rms_high),
                      cell(e.axis_rms.x()), cell(e.axis_rms.y()), cell(e.axis_rms.z()),
                      cell(e.bias.x()), cell(e.noise.x()), cell(e.noise.y()), cell(e.noise_px)});
    }
    report_.Table(fmt::format("{}: errors (mm)", WordsFor(target)),
                  {"ψ (°)", "point", "found", "incidence (°)", "rms", "95 %", "depth", "across",
                   "up", "bias in depth", "noise, depth", "noise, across", "noise (px)"},
                  rows);
  }

  // Of a row at the common angle, or of the nearest below.
  static double AtCommon(const PlotCurve& curve) {
    double value = std::numeric_limits<double>::quiet_NaN();
    for (size_t i = 0; i < curve.x.size(); ++i) {
      if (curve.x[i] <= kCommon_deg) value = curve.y[i];
    }
    return value;
  }

  void BesideTheThesis() {
    report_.Heading("Beside Borghese and Ferrigno");
    json traces = json::array();
    const auto relative = [&](PlotCurve curve) {
      const double common = AtCommon(curve);
      for (double& y : curve.y) y /= common;
      traces.push_back(Trace(curve));
    };
    PlotCurve thesis{"Borghese and Ferrigno", {}, {}, kBlack, "lines"};
    PlotCurve strips{"1 / sin(ψ/2)", {}, {}, kGrey, "lines", "dash"};
    PlotCurve rays{"two rays, rms of all axes", {}, {}, kGrey, "lines", "dot"};
    for (double psi_deg = 15.0; psi_deg <= 150.0; psi_deg += 1.0) {
      Append(thesis, psi_deg, thesis_.Error_mm(RadFromDeg(psi_deg)));
      Append(strips, psi_deg, 1.0 / std::sin(0.5 * RadFromDeg(psi_deg)));
      Append(rays, psi_deg, RaySigma_mm(1.0, psi_deg).norm());
    }
    for (const PlotCurve& curve : {thesis, strips, rays}) relative(curve);
    for (const StereoTarget target : study_.options.targets) {
      const bool panel = target == StereoTarget::kPanel;
      PlotCurve noise{
          fmt::format("noise, {}", NameOf(target)), {}, {}, panel ? kBlue : kSky, "lines+markers"};
      PlotCurve rms{fmt::format("rms, {}", NameOf(target)),
                    {},
                    {},
                    panel ? kVermillion : kOrange,
                    "lines+markers"};
      for (const StereoRow* row : study_.Rows(target, MarkerPoint::kCentre)) {
        if (row->error.found == 0) continue;
        Append(noise, row->psi_deg, row->error.noise.norm());
        Append(rms, row->psi_deg, row->error.rms);
      }
      relative(noise);
      relative(rms);
    }
    Draw(
        fmt::format("Errors relative to those at {:g} degrees (or the nearest angle below that was "
                    "measured); the fitted middle of markers",
                    kCommon_deg),
        traces, LogY("error, relative"));
    report_.Paragraph(
        "Borghese and Ferrigno's curve is the greatest error of a reconstructed point for image "
        "errors that are the same at all angles; the thesis takes it as symmetric about 90 "
        "degrees. "
        "Two cameras that look at a marker from further apart both see it at a greater angle of "
        "incidence (half the separation if it faces the bisector), smaller and dimmer, so that the "
        "image error itself grows: beyond 90 degrees sheeting, not geometry, sets the limit.");
  }

  void FoundShare() {
    report_.Heading("How many are found at all");
    json traces = json::array();
    for (const StereoTarget target : study_.options.targets) {
      PlotCurve share{WordsFor(target), {}, {}};
      for (const StereoRow* row : study_.Rows(target, MarkerPoint::kCentre)) {
        share.x.push_back(row->psi_deg);
        share.y.push_back(100.0 * static_cast<double>(row->error.found) /
                          static_cast<double>(row->error.expected));
      }
      traces.push_back(Trace(share));
    }
    Draw("Markers that both cameras name, of those there are", traces, AxisTitle("%"));
    int misnamed = 0;
    for (const StereoRow& row : study_.rows)
      misnamed += row.point == MarkerPoint::kCentre ? row.misnamed : 0;
    report_.Paragraph(fmt::format("Detections with a wrong name: **{}**.", misnamed));
  }

  const StereoStudy& study_;
  Scenario scenario_;
  ReconstructionError thesis_;
  Report& report_;
};

}  // namespace

void AddErrorCurves(const StereoStudy& study, Report& report) {
  ErrorCurves(study, report).Add();
}

}  // namespace retrolux
