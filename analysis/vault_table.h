// Table 4.9 of the thesis, its rows beside ours.
#pragma once

#include <string>
#include <vector>

#include "analysis/vault_study.h"

namespace retrolux {

std::vector<std::string> SolutionColumns();
// What the thesis printed.
std::vector<std::string> SolutionRow(const std::string& name, const ThesisSolution& printed);
// What we make of a placement in the study's room.
std::vector<std::string> SolutionRow(const std::string& name, const VaultStudy& study,
                                     const PlacementResult& result);

// The thesis's rows of a study, each printed and as our program sees the same placement; then our
// optimum. Rows of a solution that `printed_before` names are left out, and added to it.
std::vector<std::vector<std::string>> SolutionRows(const VaultStudy& study,
                                                   std::vector<std::string>& printed_before);

// Why the two can't be compared column by column.
extern const char* const kSolutionNote;

// What the scenario remarks on the printed rows, as sentences; "" if nothing.
std::string SolutionRemarks(const VaultStudy& study);

}  // namespace retrolux
