// A figure for Report::Plot.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

namespace retrolux {

struct PlotlyFigure {
  nlohmann::json traces = nlohmann::json::array();
  nlohmann::json layout = nlohmann::json::object();
  int height_px = 420;
};

// An axis with its title.
inline nlohmann::json AxisTitle(const std::string& text) {
  return {{"title", {{"text", text}}}};
}

// Of the page's palette (Okabe and Ito), for traces that must keep their colour across figures.
namespace plot_colour {
inline constexpr const char* kBlue = "#0072b2";
inline constexpr const char* kVermillion = "#d55e00";
inline constexpr const char* kGreen = "#009e73";
inline constexpr const char* kPurple = "#cc79a7";
inline constexpr const char* kOrange = "#e69f00";
inline constexpr const char* kSky = "#56b4e9";
inline constexpr const char* kBlack = "#1a1a1a";
inline constexpr const char* kGrey = "#8a929c";
}  // namespace plot_colour

}  // namespace retrolux
