// A room as the study of hot spots needs it.
#pragma once

#include "scenes/scene.h"

namespace retrolux {

// The room with markers: its own or, if it has none, the six identifiable ones on the oval of the
// CT room, three that face the front cameras and three that face the back ones. InputError if it
// has no object "mask" to put them on, or a camera without a ring.
Scene HotspotRoom(const Scene& room);

}  // namespace retrolux
