// Which axis of a world points up: x in the CT room, z in the vault (core/conventions.h).
#pragma once

namespace retrolux {

enum class UpAxis { kX, kZ };

}  // namespace retrolux
