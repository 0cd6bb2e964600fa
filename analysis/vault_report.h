// report.html of the camera placement study.
#pragma once

#include "analysis/vault_study.h"

namespace retrolux {

// One simulation: its height maps, costs, table 4.9's rows beside ours, the vault drawn from above
// and from the side, the mask coloured by how many cameras see it, what the cameras see.
void WriteVaultReport(const VaultStudy& study, MaskStores& stores,
                      const std::filesystem::path& folder, const std::string& command_line);

// Several simulations side by side: table 4.9 whole, the sorted costs of all (figure 4.32).
void WriteVaultSummary(const std::vector<VaultStudy>& studies, const std::filesystem::path& folder,
                       const std::string& command_line);

}  // namespace retrolux
