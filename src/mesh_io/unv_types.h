#pragma once

namespace delvox::mesh_io {

// Numbers of I-DEAS universal files: datasets, types of elements (thin shells and solids), kinds of group members.
inline constexpr int kUnvHeader = 151, kUnvNodes = 2411, kUnvElements = 2412, kUnvGroups = 2467;
inline constexpr int kUnvTriangle3 = 91, kUnvTriangle6 = 92, kUnvTet4 = 111, kUnvTet10 = 118;
inline constexpr int kUnvNode = 7, kUnvElement = 8;

}  // namespace delvox::mesh_io
