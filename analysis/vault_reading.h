// What a placement study says in words. Every sentence follows from the study's numbers.
#pragma once

#include <string>
#include <vector>

#include "analysis/vault_study.h"

namespace retrolux {

// Paragraphs: what was found, where the thesis stands, and what the answer hangs on.
std::vector<std::string> Reading(const VaultStudy& study);

// Of all studies of a run.
std::vector<std::string> Reading(const std::vector<VaultStudy>& studies);

// Smallest and largest of a number over the study's optimum and those under its variations.
struct Band {
  std::string name, unit;
  double ours = 0.0, least = 0.0, greatest = 0.0;
};
std::vector<Band> BandsOf(const VaultStudy& study);

}  // namespace retrolux
