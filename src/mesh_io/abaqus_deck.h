#pragma once

#include "delvox/mesh_io/write_deck.h"
#include "mesh_io/mesh_view.h"
#include "mesh_io/out.h"

namespace delvox::mesh_io {

/// Throws OptionError unless write_static_step can be kept: see write_deck.
void check_deck(const MeshView& mesh, const StaticDeck& deck);

/// The *STEP of a static analysis. pre: check_deck has passed.
void write_static_step(const MeshView& mesh, const StaticDeck& deck, Out& out);

}  // namespace delvox::mesh_io
