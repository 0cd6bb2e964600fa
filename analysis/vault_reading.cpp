#include "analysis/vault_reading.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <set>

#include "analysis/vault_text.h"

namespace retrolux {

namespace {

bool Same(const Placement& a, const Placement& b) {
  constexpr double kSlack_deg = 0.01;  // the thesis prints two decimals
  return std::abs(a.phi_b_deg - b.phi_b_deg) < kSlack_deg &&
         std::abs(a.theta1_deg - b.theta1_deg) < kSlack_deg &&
         std::abs(a.theta2_deg - b.theta2_deg) < kSlack_deg;
}

double Mean(const std::vector<double>& values) {
  return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

size_t Orientations(const VaultStudy& study) {
  size_t sum = 0;
  for (const auto& rotations : study.rotations) sum += rotations.size();
  return sum;
}

std::string RangeOf(const std::string& least, const std::string& greatest) {
  return least == greatest ? least : fmt::format("{} to {}", least, greatest);
}

std::string Masks(const VaultStudy& study) {
  return fmt::format("{} mask{}", fmt::join(study.options.masks, " and "),
                     study.options.masks.size() > 1 ? "s" : "");
}

std::string Found(const VaultStudy& study) {
  const PlacementResult& best = study.best.result;
  const PlacementWorth& e = best.Worst();
  std::string text =
      study.results.size() == 1
          ? fmt::format("One placement was looked at, **{}**, over {} orientations of the {}. ",
                        TextOf(best.Where()), Orientations(study), Masks(study))
          : fmt::format(
                "Of {} placements of {} cameras, each over {} orientations of the {}, the best in "
                "its worst orientation is **{}**. ",
                study.results.size(), study.scenario.cameras.count, Orientations(study),
                Masks(study), TextOf(best.Where()));
  if (e.worth.combination == 0) {
    return text + fmt::format(
                      "In that orientation ({}) no combination of cameras counts: each has a pair "
                      "closer than {}.",
                      TextOf(WorstRotation(study, best)),
                      Degrees(study.scenario.combinations.min_separation_deg));
  }
  return text + fmt::format(
                    "That orientation is {} of the {}: at least two of cameras **{}** see **{:.0f} "
                    "cm²** of it ({:.1f} %), stand {:.1f}° apart or more and locate a marker to "
                    "{:.2f} mm. Cost {:.3f}.",
                    TextOf(WorstRotation(study, best)), study.options.masks[best.WorstMask()],
                    NameOf(e.worth.combination), e.worth.area_mm2 / 100.0,
                    100.0 * e.worth.area_mm2 / study.mask_area_mm2[best.WorstMask()],
                    DegFromRad(e.min_angle_rad), e.recon_error_mm, e.Cost());
}

// A rig at the end of what was looked at: a bound decides its height, not the cost.
std::string AtWhichEnd(double theta_deg, const std::set<double>& thetas_deg) {
  if (thetas_deg.size() < 2) return "";
  if (theta_deg <= *thetas_deg.begin() + 1e-6) return ", the highest that was looked at";
  if (theta_deg >= *thetas_deg.rbegin() - 1e-6) return ", the lowest that was looked at";
  return "";
}

std::string Rigs(const VaultStudy& study) {
  const Placement& best = study.best.result.Where();
  std::set<double> first, second;
  for (const PlacementResult& result : study.results) {
    first.insert(result.Where().theta1_deg);
    second.insert(result.Where().theta2_deg);
  }
  if (study.scenario.rigs.same_height) {
    return fmt::format("All cameras hang {:.0f} mm over the floor{}.",
                       OverFloor_mm(study.scenario, best.theta1_deg),
                       AtWhichEnd(best.theta1_deg, first));
  }
  return fmt::format(
      "Rig 1 (even cameras) hangs {:.0f} mm over the floor{}; rig 2 (odd ones) {:.0f} mm{}.",
      OverFloor_mm(study.scenario, best.theta1_deg), AtWhichEnd(best.theta1_deg, first),
      OverFloor_mm(study.scenario, best.theta2_deg), AtWhichEnd(best.theta2_deg, second));
}

// A combination that hangs on one rig: then the other one's height is not what limits the optimum.
std::string OneRigDecides(const VaultStudy& study) {
  const CameraSet combination = study.best.result.Worst().worth.combination;
  constexpr CameraSet kRig2 = 0x55555555u;  // cameras 1, 3, 5, ...
  if (study.scenario.rigs.same_height || combination == 0) return "";
  if ((combination & ~kRig2) != 0 && (combination & kRig2) != 0) return "";
  const bool second = (combination & kRig2) != 0;
  return fmt::format(
      " All cameras of the combination hang on rig {}: while it is the best one, the height of rig "
      "{} does not count in the worst orientation.",
      second ? 2 : 1, second ? 1 : 2);
}

// How flat the optimum is: the placements that are nearly as good.
std::string NearlyAsGood(const VaultStudy& study) {
  constexpr double kNear = 0.01;
  const Placement& best = study.best.result.Where();
  Placement least = best, greatest = best;
  int count = 0;
  for (const PlacementResult& result : study.results) {
    if (result.Cost() < (1.0 - kNear) * study.best.result.Cost()) continue;
    ++count;
    for (const auto which :
         {&Placement::phi_b_deg, &Placement::theta1_deg, &Placement::theta2_deg}) {
      least.*which = std::min(least.*which, result.Where().*which);
      greatest.*which = std::max(greatest.*which, result.Where().*which);
    }
  }
  if (count < 2) return "No other placement that was looked at comes within 1 % of it.";
  return fmt::format("{} other placement{} within 1 % of it: φb {}, θ₁ {}, θ₂ {}.", count - 1,
                     count == 2 ? " lies" : "s lie",
                     RangeOf(Degrees(least.phi_b_deg), Degrees(greatest.phi_b_deg)),
                     RangeOf(Degrees(least.theta1_deg), Degrees(greatest.theta1_deg)),
                     RangeOf(Degrees(least.theta2_deg), Degrees(greatest.theta2_deg)));
}

// In how many orientations of all masks a is worth more than b.
size_t Wins(const NamedResult& a, const NamedResult& b) {
  size_t wins = 0;
  for (size_t m = 0; m < a.orientations.size(); ++m) {
    for (size_t i = 0; i < a.orientations[m].size(); ++i)
      wins += a.orientations[m][i].cost_mm2 > b.orientations[m][i].cost_mm2 ? 1 : 0;
  }
  return wins;
}

std::string RunnerUp(const VaultStudy& study) {
  const NamedResult &best = study.best, &other = *study.runner_up;
  std::string text =
      fmt::format("The best placement that is not beside it on the grid ({}) reaches {:.3f} ({})",
                  TextOf(other.result.Where()), other.result.Cost(),
                  SignedPercent(other.result.Cost() / best.result.Cost() - 1.0));
  if (best.orientations.empty() || other.orientations.empty()) return text + ".";
  const size_t mask = best.result.WorstMask();
  return text + fmt::format(
                    "; it is the better one in {} of {} orientations. Mean over the orientations "
                    "of the {}: {:.3f} for the optimum, {:.3f} for it.",
                    Wins(other, best), Orientations(study), study.options.masks[mask],
                    Mean(CostsOf(best.orientations[mask])),
                    Mean(CostsOf(other.orientations[mask])));
}

std::string Thesis(const VaultStudy& study) {
  std::string text;
  const double best = study.best.result.Cost();
  for (size_t i = 0; i < study.thesis.size(); ++i) {
    const ThesisSolution& printed = study.scenario.thesis[i];
    const PlacementResult& here = study.thesis[i].result;
    text += fmt::format(
        "{}The thesis's solution {} ({}) is worth **{:.3f}** here, where the thesis prints {:.3f}",
        text.empty() ? "" : " ", printed.name, TextOf(here.Where()), here.Cost(), printed.cost);
    text += Same(here.Where(), study.best.result.Where())
                ? "; it is the optimum here too."
                : fmt::format("; against the placement above that is {}.",
                              SignedPercent(here.Cost() / best - 1.0));
  }
  return text;
}

bool InIntervals(const SearchSpec& search, const Placement& p) {
  constexpr double kSlack_deg = 1e-6;
  const auto in = [](const Steps& steps, double deg) {
    return deg > steps.from - kSlack_deg && deg < steps.to + kSlack_deg;
  };
  return in(search.phi_b_deg, p.phi_b_deg) && in(search.theta_deg, p.theta1_deg) &&
         in(search.theta_deg, p.theta2_deg);
}

std::string Sensitivity(const VaultStudy& study) {
  const auto by_cost = [](const NamedResult& a, const NamedResult& b) {
    return a.result.Cost() < b.result.Cost();
  };
  const auto [least, most] =
      std::minmax_element(study.sensitivity.begin(), study.sensitivity.end(), by_cost);
  const double best = study.best.result.Cost();
  std::string text = fmt::format("Of all single moves of the optimum `{}` costs most ({})",
                                 least->name, SignedPercent(least->result.Cost() / best - 1.0));
  if (most->result.Cost() > best) {
    text += fmt::format("; `{}` gains {}, {}", most->name,
                        SignedPercent(most->result.Cost() / best - 1.0),
                        InIntervals(study.scenario.search, most->result.Where())
                            ? "between the points that were looked at"
                            : "outside the intervals of the search");
  }
  return text + ".";
}

std::string NearOptimum(const VaultStudy& study) {
  std::string text;
  const double best = study.best.result.Cost();
  if (study.refined) {
    text += fmt::format("Between the grid's points the climb ends at {} ({}). ",
                        TextOf(study.refined->placement),
                        SignedPercent(study.refined->cost / best - 1.0));
  }
  if (study.snapped) {
    text += fmt::format("Rounded to what a workshop builds it is {} ({}).",
                        TextOf(study.snapped->result.Where()),
                        SignedPercent(study.snapped->result.Cost() / best - 1.0));
  }
  return text;
}

std::string Variations(const VaultStudy& study) {
  std::string text =
      fmt::format("Under {} variations of what nobody knows well: ", study.variations.size());
  for (const Band& band : BandsOf(study)) {
    const auto number = [&](double value) {
      return band.unit.empty() ? fmt::format("{:.3f}", value) : Degrees(value);
    };
    text += fmt::format("{} {}, ", band.name, RangeOf(number(band.least), number(band.greatest)));
  }
  text.resize(text.size() - 2);
  const auto loss = [](const VariedOptimum& v) { return v.cost_of_ours / v.best.Cost() - 1.0; };
  const auto worst = std::min_element(
      study.variations.begin(), study.variations.end(),
      [&](const VariedOptimum& a, const VariedOptimum& b) { return loss(a) < loss(b); });
  const double half_step = 0.5 * study.scenario.search.theta_deg.step + 1e-6;
  const Placement& ours = study.best.result.Where();
  const auto keeps =
      std::count_if(study.variations.begin(), study.variations.end(), [&](const VariedOptimum& v) {
        return std::abs(v.best.Where().theta1_deg - ours.theta1_deg) < half_step &&
               std::abs(v.best.Where().theta2_deg - ours.theta2_deg) < half_step;
      });
  return text + fmt::format(
                    ". Both rigs stay within half a step of the grid in {} of {}. Built as above, "
                    "the cameras lose most against the best placement under `{}` ({}).",
                    keeps, study.variations.size(), worst->name, SignedPercent(loss(*worst)));
}

std::string Warnings(const VaultStudy& study) {
  std::string text;
  if (study.views_cut > 0) {
    text += fmt::format(
        "In {} of {} views of this placement the mask is larger than the picture; what falls "
        "beside "
        "it counts as not seen. ",
        study.views_cut, study.views);
  }
  if (study.rotations_too_close > 0) {
    text += fmt::format(
        "In {} orientations the snout is fully contracted and still closer to the mask than {:g} "
        "mm.",
        study.rotations_too_close, study.scenario.nozzle.gap_mm);
  }
  return text;
}

}  // namespace

std::vector<Band> BandsOf(const VaultStudy& study) {
  const auto band = [&](const char* name, const char* unit, auto value) {
    Band made{name, unit, value(study.best.result), value(study.best.result),
              value(study.best.result)};
    for (const VariedOptimum& varied : study.variations) {
      made.least = std::min(made.least, value(varied.best));
      made.greatest = std::max(made.greatest, value(varied.best));
    }
    return made;
  };
  using Result = PlacementResult;
  return {band("φb", "°", [](const Result& r) { return r.Where().phi_b_deg; }),
          band("θ₁", "°", [](const Result& r) { return r.Where().theta1_deg; }),
          band("θ₂", "°", [](const Result& r) { return r.Where().theta2_deg; }),
          band("cost", "", [](const Result& r) { return r.Cost(); })};
}

std::vector<std::string> Reading(const VaultStudy& study) {
  std::vector<std::string> paragraphs = {Found(study), Rigs(study) + OneRigDecides(study)};
  if (study.results.size() > 1) paragraphs.push_back(NearlyAsGood(study));
  if (study.runner_up) paragraphs.back() += fmt::format(" {}", RunnerUp(study));
  if (!study.thesis.empty()) paragraphs.push_back(Thesis(study));
  if (!study.sensitivity.empty()) paragraphs.push_back(Sensitivity(study));
  if (study.refined || study.snapped) paragraphs.push_back(NearOptimum(study));
  if (!study.variations.empty()) paragraphs.push_back(Variations(study));
  if (const std::string warnings = Warnings(study); !warnings.empty())
    paragraphs.push_back(warnings);
  return paragraphs;
}

namespace {

std::string BeamsText(size_t beams) {
  return beams == 1 ? "one beam" : fmt::format("{} beams", beams);
}

// Names joined from the highest cost to the lowest: "1a (2.84) > 2 (2.70)".
std::string Ranking(std::vector<std::pair<double, std::string>> costs) {
  std::stable_sort(costs.begin(), costs.end(),
                   [](const auto& a, const auto& b) { return a.first > b.first; });
  std::string text;
  for (const auto& [cost, name] : costs)
    text += fmt::format("{}{} ({:.3f})", text.empty() ? "" : " > ", name, cost);
  return text;
}

// Searches with so many beams, best first, ours and the thesis's.
std::string Best(const std::vector<VaultStudy>& studies, size_t beams) {
  std::vector<std::pair<double, std::string>> ours, printed;
  for (const VaultStudy& study : studies) {
    if (study.options.placement || study.scenario.beams.size() != beams) continue;
    ours.emplace_back(study.best.result.Cost(), study.scenario.name);
    if (!study.scenario.thesis.empty())
      printed.emplace_back(study.scenario.thesis.front().cost, study.scenario.thesis.front().name);
  }
  if (ours.empty()) return "";
  std::string text =
      fmt::format("With {}: **{}** by our optima", BeamsText(beams), Ranking(std::move(ours)));
  if (!printed.empty()) text += fmt::format("; the thesis prints {}", Ranking(std::move(printed)));
  return text + ".";
}

// How the thesis's own placements fare against the optima of the same rooms.
std::string ThesisLosses(const std::vector<VaultStudy>& studies) {
  double least = 1e300, greatest = -1e300;
  std::string least_name, greatest_name;
  int same = 0, rows = 0;
  for (const VaultStudy& study : studies) {
    if (study.options.placement || study.thesis.empty()) continue;
    const PlacementResult& here = study.thesis.front().result;
    const double change = here.Cost() / study.best.result.Cost() - 1.0;
    ++rows;
    same += Same(here.Where(), study.best.result.Where()) ? 1 : 0;
    if (change < least) {
      least = change;
      least_name = study.thesis.front().name;
    }
    if (change > greatest) {
      greatest = change;
      greatest_name = study.thesis.front().name;
    }
  }
  if (rows == 0) return "";
  return fmt::format(
      "The thesis's optimum is ours in {} of {} rooms. Against our optimum in the same room its "
      "placements come to {} (solution {}) at worst and {} (solution {}) at best.",
      same, rows, SignedPercent(least), least_name, SignedPercent(greatest), greatest_name);
}

// Placements that were found in one room and tried in another.
std::string Elsewhere(const std::vector<VaultStudy>& studies) {
  std::string text;
  for (const VaultStudy& study : studies) {
    if (!study.options.placement) continue;
    const auto home = std::find_if(studies.begin(), studies.end(), [&](const VaultStudy& other) {
      return !other.options.placement && other.scenario.description == study.scenario.description;
    });
    const double cost = study.best.result.Cost();
    text += fmt::format("{}**{}** ({}) is worth {:.3f}", text.empty() ? "" : " ",
                        study.scenario.name, TextOf(study.best.result.Where()), cost);
    text += home == studies.end()
                ? "."
                : fmt::format(", {} against that room's own optimum.",
                              SignedPercent(cost / home->best.result.Cost() - 1.0));
  }
  return text;
}

}  // namespace

std::vector<std::string> Reading(const std::vector<VaultStudy>& studies) {
  std::set<size_t, std::greater<>> beams;
  for (const VaultStudy& study : studies) beams.insert(study.scenario.beams.size());
  std::vector<std::string> paragraphs;
  for (const size_t count : beams) paragraphs.push_back(Best(studies, count));
  paragraphs.push_back(ThesisLosses(studies));
  paragraphs.push_back(Elsewhere(studies));
  std::erase(paragraphs, "");
  return paragraphs;
}

}  // namespace retrolux
