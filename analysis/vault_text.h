// How the reports of the placement study write its numbers.
#pragma once

#include <string>
#include <vector>

#include "analysis/vault_study.h"

namespace retrolux {

std::string Degrees(double deg);                 // "31.67°", at most two decimals
std::string TextOf(const Placement& placement);  // "φb 60°, θ₁ 31.67°, θ₂ 70.52°"
std::string TextOf(const MaskRotation& rotation);
std::string SignedPercent(double fraction);  // "+1.2 %", "−0.3 %"

// Height of a rig over the floor.
double OverFloor_mm(const Scenario& scenario, double theta_deg);

// Costs of orientations in the unit of PlacementWorth::Cost().
std::vector<double> CostsOf(const std::vector<OrientationWorth>& orientations);

// The orientation that a result's cost is of.
const MaskRotation& WorstRotation(const VaultStudy& study, const PlacementResult& result);

}  // namespace retrolux
