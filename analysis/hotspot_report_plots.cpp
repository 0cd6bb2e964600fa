#include "analysis/hotspot_report_plots.h"

#include <cmath>
#include <functional>
#include <limits>

#include "analysis/area_plots.h"

namespace retrolux {

namespace {

using nlohmann::json;
using namespace plot_colour;

// Logarithmic axes have no zero.
double Positive(double value) {
  return value > 0.0 ? value : std::numeric_limits<double>::quiet_NaN();
}

class HotspotPlots {
 public:
  HotspotPlots(const HotspotSeries& series, Report& report) : series_(series), report_(report) {}

  void Add() {
    Mechanisms();
    Levels();
    Markers();
    Finding();
    Places();
  }

 private:
  using RowValue = std::function<double(const HotspotRow&)>;

  json Curve(const std::string& name, const RowValue& value, const char* colour,
             const char* dash = "solid", const RowValue& error = nullptr) const {
    PlotCurve curve{name, {}, {}, colour, "lines+markers", dash};
    json errors = json::array();
    for (const HotspotRow& row : series_.rows) {
      curve.x.push_back(row.psi_deg);
      curve.y.push_back(value(row));
      if (error) errors.push_back(error(row));
    }
    json trace = FigureOf({curve}, json::object(), json::object()).traces.front();
    if (error) trace["error_y"] = {{"array", errors}};
    return trace;
  }

  // With the thesis's limit drawn in.
  void Draw(const std::string& caption, json traces, json y_axis) {
    const json line = {{"type", "line"},
                       {"x0", kThesisLimit_deg},
                       {"x1", kThesisLimit_deg},
                       {"yref", "paper"},
                       {"y0", 0},
                       {"y1", 1},
                       {"line", {{"color", kVermillion}, {"dash", "dash"}, {"width", 1}}}};
    const json label = {
        {"x", kThesisLimit_deg}, {"y", 1},           {"yref", "paper"},  {"text", "thesis: 15°"},
        {"showarrow", false},    {"yanchor", "top"}, {"xanchor", "left"}};
    report_.Plot(caption, std::move(traces),
                 {{"xaxis", AxisTitle("separation of the cameras ψ (degrees)")},
                  {"yaxis", std::move(y_axis)},
                  {"shapes", json::array({line})},
                  {"annotations", json::array({label})}},
                 440);
  }

  static RowValue Level(const char* mix, double HotspotLevels::*level) {
    return [mix, level](const HotspotRow& row) { return row.Mix(mix).mean.*level; };
  }
  static RowValue LevelError(const char* mix, double HotspotLevels::*level) {
    return [mix, level](const HotspotRow& row) { return row.Mix(mix).error.*level; };
  }
  static RowValue Method(const char* mix, const char* method, double HotspotMethodRow::*figure) {
    return [=](const HotspotRow& row) { return Positive(row.Mix(mix).methods.at(method).*figure); };
  }
  // Of the nearest neighbour, or (own) of the own ring.
  static RowValue Ring(bool own, double RingLight::*part) {
    return [=](const HotspotRow& row) {
      for (const RingLight& ring : row.rings) {
        if ((ring.separation_deg == 0.0) == own) return Positive(ring.*part);
      }
      return Positive(0.0);
    };
  }
  static RowValue Highlights(bool own, double Highlight::*part) {
    return [=](const HotspotRow& row) {
      for (const RingLight& ring : row.rings) {
        if ((ring.separation_deg == 0.0) == own) return Positive(ring.highlight.*part);
      }
      return Positive(0.0);
    };
  }

  void Mechanisms() {
    report_.Heading("Light of the neighbour, by mechanism");
    json traces = {
        Curve("highlight on the coat, peak", Highlights(false, &Highlight::peak_e), kVermillion),
        Curve("own ring's highlight, peak", Highlights(true, &Highlight::peak_e), kOrange, "dot"),
        Curve("beam on the mask's body", Ring(false, &RingLight::beam_e), kBlue),
        Curve("own ring's beam", Ring(true, &RingLight::beam_e), kSky, "dot"),
        Curve("retro-reflective lobe of markers", Ring(false, &RingLight::lobe_e), kGreen),
        Curve("own ring's lobe", Ring(true, &RingLight::lobe_e), kGreen, "dot"),
        Curve("body of the sheeting", Ring(false, &RingLight::sheet_e), kPurple),
        Curve("cover of the sheeting", Ring(false, &RingLight::cover_e), kBlack),
        Curve("noise of a pixel of the mask", Level("own", &HotspotLevels::background_noise_e),
              kGrey, "dash")};
    Draw(
        "Mean signal in the picture by what sent it (e-): the neighbour's, beside that of the own "
        "ring (dotted) and the noise",
        traces, LogAxisTitle("e-"));
    report_.Paragraph(
        "A ring can be seen directly only where its camera stands in the picture: for two cameras "
        "at the same distance, which look at the isocentre, not before they stand 165 degrees "
        "apart (the neighbour stands 90° - ψ/2 off the axis, the field's corner 7.6°).");
  }

  void Levels() {
    report_.Heading("Levels of the picture");
    const auto level = [&](double HotspotLevels::*figure, const std::string& caption, json axis) {
      json traces = json::array();
      const std::pair<const char*, const char*> mixes[] = {
          {"own", kBlue}, {"both", kVermillion}, {"neighbour", kGreen}, {"both_polarised", kGrey}};
      for (const auto& [mix, colour] : mixes)
        traces.push_back(Curve(mix, Level(mix, figure), colour, "solid", LevelError(mix, figure)));
      Draw(caption, traces, std::move(axis));
    };
    level(&HotspotLevels::peak_e, "Brightest pixel of the bare mask", AxisTitle("e-"));
    level(&HotspotLevels::saturated_px, "Pixels at the full well", AxisTitle("px"));
    level(&HotspotLevels::background_e, "Level of the mask around markers", AxisTitle("e-"));
    level(&HotspotLevels::gradient_e_px, "Its slope", AxisTitle("e- / px"));
    level(&HotspotLevels::contrast, "Contrast of markers, (marker - mask) / mask", AxisTitle(""));
    Draw("Area of the highlights (pixels at half their peak and above)",
         {Curve("own ring", Highlights(true, &Highlight::area_px), kBlue),
          Curve("neighbour", Highlights(false, &Highlight::area_px), kVermillion)},
         AxisTitle("px"));
  }

  void Markers() {
    report_.Heading("Places of markers");
    json traces = json::array();
    const std::pair<const char*, const char*> methods[] = {{"edges", kBlue},
                                                           {"robust", kVermillion}};
    for (const auto& [method, colour] : methods) {
      traces.push_back(Curve(fmt::format("centroid, {}", method),
                             Method("both", method, &HotspotMethodRow::centroid_shift_px), colour));
      traces.push_back(Curve(fmt::format("its noise in one picture, {}", method),
                             Method("own", method, &HotspotMethodRow::centroid_noise_px), colour,
                             "dot"));
    }
    Draw("Shift of centroids by the neighbour (noise-free, rms over markers), beside their noise",
         traces, LogAxisTitle("px"));
    traces = json::array();
    for (const auto& [method, colour] : methods) {
      traces.push_back(Curve(fmt::format("corners, {}", method),
                             Method("both", method, &HotspotMethodRow::corner_shift_px), colour));
      traces.push_back(Curve(fmt::format("their noise in one picture, {}", method),
                             Method("own", method, &HotspotMethodRow::corner_noise_px), colour,
                             "dot"));
    }
    Draw("Shift of corners by the neighbour (noise-free, rms), beside their noise", traces,
         LogAxisTitle("px"));
    Draw(
        "Shift of centroids in noisy pictures: of the mean over the exposures, the noise's own "
        "part taken off; bars 1 sigma",
        {Curve(
             "robust",
             [](const HotspotRow& row) {
               return std::max(0.0, row.Mix("both").methods.at("robust").noisy_shift_px);
             },
             kVermillion, "solid",
             [](const HotspotRow& row) {
               return row.Mix("both").methods.at("robust").noisy_shift_error_px;
             }),
         Curve(
             "edges",
             [](const HotspotRow& row) {
               return std::max(0.0, row.Mix("both").methods.at("edges").noisy_shift_px);
             },
             kBlue, "solid",
             [](const HotspotRow& row) {
               return row.Mix("both").methods.at("edges").noisy_shift_error_px;
             })},
        AxisTitle("px"));
  }

  void Finding() {
    report_.Heading("Names");
    json hits = json::array(), wrong = json::array();
    const std::pair<const char*, const char*> mixes[] = {
        {"own", kBlue}, {"both", kVermillion}, {"neighbour", kGreen}};
    for (const auto& [mix, colour] : mixes) {
      for (const char* method : {"edges", "robust"}) {
        const char* dash = std::string(method) == "edges" ? "dot" : "solid";
        const auto rate = [mix = mix, method](const HotspotRow& row) -> const Proportion& {
          return row.Mix(mix).methods.at(method).hits;
        };
        hits.push_back(Curve(
            fmt::format("{}, {}", mix, method),
            [rate](const HotspotRow& row) { return 100.0 * rate(row).Value().value_or(0.0); },
            colour, dash,
            [rate](const HotspotRow& row) {
              const Interval interval = rate(row).Wilson();
              return 50.0 * (interval.high - interval.low);
            }));
        wrong.push_back(Curve(
            fmt::format("{}, {}", mix, method),
            [mix = mix, method](const HotspotRow& row) {
              return row.Mix(mix).methods.at(method).false_detections;
            },
            colour, dash,
            [mix = mix, method](const HotspotRow& row) {
              return row.Mix(mix).methods.at(method).false_error;
            }));
      }
    }
    Draw("Markers named rightly, of those wholly seen (%)", hits, AxisTitle("%"));
    Draw("False detections a picture: wrong names, and patterns off every marker", wrong,
         AxisTitle("a picture"));
  }

  void Places() {
    report_.Heading("Where highlights seem to be");
    const auto depth = [](double HighlightDepths::*which) -> RowValue {
      return [which](const HotspotRow& row) {
        const HighlightDepths& depths = row.shots.front().depths;
        return depths.known ? depths.*which : std::numeric_limits<double>::quiet_NaN();
      };
    };
    Draw("Highlights of the bare mask, triangulated by the pair: depth behind the surface",
         {Curve("cross highlight", depth(&HighlightDepths::cross_mm), kVermillion),
          Curve("own highlights", depth(&HighlightDepths::own_mm), kBlue)},
         AxisTitle("mm"));
    report_.Paragraph(
        "Each camera sees the other's highlight where the normal bisects the directions to both, "
        "which is the same point for both: the **cross highlight** triangulates on the surface, "
        "like a marker. A camera's **own** highlight lies where the normal points at it; the rays "
        "of two cameras to their own highlights meet where the normals do, at the centre of "
        "curvature: 100 mm behind the surface of the oval.");
    PlotCurve form{"2 R sin(ψ/4), R = 100 mm", {}, {}, kGrey, "lines", "dash"};
    for (const HotspotRow& row : series_.rows) {
      form.x.push_back(row.psi_deg);
      form.y.push_back(200.0 * std::sin(0.25 * RadFromDeg(row.psi_deg)));
    }
    json traces = {Curve("measured", depth(&HighlightDepths::apart_mm), kBlue)};
    if (series_.setup.mask == "oval")
      traces.push_back(FigureOf({form}, json::object(), json::object()).traces.front());
    Draw("Own and cross highlight of one camera: their distance on the surface", traces,
         AxisTitle("mm"));
  }

  const HotspotSeries& series_;
  Report& report_;
};

}  // namespace

void AddHotspotPlots(const HotspotSeries& series, Report& report) {
  HotspotPlots(series, report).Add();
}

}  // namespace retrolux
