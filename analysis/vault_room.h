// The vault of a placement study in three dimensions.
#pragma once

#include "analysis/room_figure.h"
#include "analysis/vault_study.h"

namespace retrolux {

// The optimum in its worst, its best and the first orientation of the mask that decides, and the
// runner-up and the thesis's placements in their worst: nozzles, cameras, and the mask coloured by
// how many cameras see it.
RoomFigure DrawVaultRoom(const VaultStudy& study);

}  // namespace retrolux
