#pragma once

#include <string_view>
#include <utility>
#include <vector>

#include "mesh_io/source.h"

namespace delvox::mesh_io {

/// An element of an XML file; the views point into the source.
struct XmlNode {
  std::string_view name;
  std::vector<std::pair<std::string_view, std::string_view>> attributes;
  std::string_view text;  ///< up to the first child or the end tag
  std::vector<XmlNode> children;

  /// The value of an attribute, or `otherwise` if it is not there.
  std::string_view attribute(std::string_view key, std::string_view otherwise = {}) const;
  /// The first child of that name, or null.
  const XmlNode* child(std::string_view key) const;
};

/// Parses as much XML as VTK files use: elements, attributes, comments, processing instructions; no entities. Elements
/// still open at the end of the text are closed there, since raw appended data follows that is no XML at all.
/// Throws InputError.
XmlNode parse_xml(const Source& source, std::string_view text);

}  // namespace delvox::mesh_io
