#pragma once

#include <optional>
#include <string>
#include <vector>

#include "delvox/core/mesh_sets.h"
#include "delvox/volume/volume.h"
#include "patient_frame.h"

namespace delvox::tools {

/// --set NAME=RULE, repeatable.
void add_set_option(CLI::App& app, std::vector<std::string>& sets);

/// The image that --set NAME=border:xmin speaks of, and how the mesh lies to it.
struct MeshedImage {
  VolumeHeader header;
  FrameChange frame;
};

/// The rules that the texts spell; world points are those of the output frame. Without an image (`image` null) border
/// rules make no sense, unless `images_later`: then they are only checked for their spelling, and come out as empty
/// rules. Throws OptionError: unknown rule, wrong count of numbers, a name that no solver would take, a name twice.
std::vector<NamedRule> parse_sets(const std::vector<std::string>& texts, const MeshedImage* image,
                                  bool images_later = false);

/// Finds the sets in the mesh. Returns the first that is empty, as a fault for people, or an empty text.
std::string apply_sets(TetMesh& mesh, const std::vector<NamedRule>& rules);

/// Throws OptionError unless `name` can name a set or material everywhere: a letter, then letters, digits, _ and -, at
/// most 40, and none that our own files use. `what`: the option, for the message.
void check_name(const std::string& name, const std::string& what);

}  // namespace delvox::tools
