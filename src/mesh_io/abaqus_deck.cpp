#include "mesh_io/abaqus_deck.h"

#include <algorithm>
#include <string>

#include "delvox/core/errors.h"
#include "mesh_io/abaqus_names.h"
#include "mesh_io/node_order.h"

namespace delvox::mesh_io {
namespace {

const MeshSet& find_set(const MeshView& mesh, const std::string& name) {
  const auto found =
      std::find_if(mesh.sets.begin(), mesh.sets.end(), [&](const MeshSet& set) { return set.name == name; });
  if (found == mesh.sets.end()) throw OptionError("the deck names the set " + name + ", which the mesh does not have");
  return *found;
}

void write_displacements(const MeshView& mesh, const StaticDeck& deck, Out& out) {
  const double scale = mesh.info.unit == LengthUnit::kMetre ? 1e-3 : 1;
  out.put("*BOUNDARY\n");
  for (const StaticDeck::Displacement& displacement : deck.displacements) {
    for (int axis = 0; axis < 3; ++axis) {
      const auto& mm = displacement.mm[static_cast<std::size_t>(axis)];
      if (mm) out.put(displacement.set, ", ", axis + 1, ", ", axis + 1, ", ", Digits12{scale * *mm}, '\n');
    }
  }
}

/// Face by face: CalculiX takes no pressure on a named surface.
void write_pressures(const MeshView& mesh, const StaticDeck& deck, Out& out) {
  const double scale = mesh.info.unit == LengthUnit::kMetre ? 1e6 : 1;
  for (const StaticDeck::Pressure& pressure : deck.pressures) {
    out.put("** pressure on ", pressure.set, "\n*DLOAD\n");
    for (TetFace face : find_set(mesh, pressure.set).faces) {
      out.put(face.tet + 1, ", P", int{kAbaqusFace[face.face]}, ", ", Digits12{scale * pressure.mpa}, '\n');
    }
  }
}

void write_gravity(const MeshView& mesh, const StaticDeck& deck, Out& out) {
  const double strength = norm(deck.gravity_m_s2);
  if (!(strength > 0)) return;
  const double scale = mesh.info.unit == LengthUnit::kMetre ? 1 : 1e3;
  const Vector3 along = (1 / strength) * deck.gravity_m_s2;
  out.put("*DLOAD\n", kAllTets, ", GRAV, ", Digits12{scale * strength}, ", ", Digits12{along.x}, ", ",
          Digits12{along.y}, ", ", Digits12{along.z}, '\n');
}

}  // namespace

void check_deck(const MeshView& mesh, const StaticDeck& deck) {
  if (deck.displacements.empty()) throw OptionError("the deck has no supports: nothing holds the body");
  for (const StaticDeck::Displacement& displacement : deck.displacements) {
    if (find_set(mesh, displacement.set).nodes.empty()) {
      throw OptionError("the deck holds the set " + displacement.set + ", which has no nodes");
    }
  }
  for (const StaticDeck::Pressure& pressure : deck.pressures) {
    if (find_set(mesh, pressure.set).faces.empty()) {
      throw OptionError("the deck presses on the set " + pressure.set + ", which has no boundary faces");
    }
  }
  for (const auto& [region, tets] : regions_of(mesh)) {
    const Material* material = mesh.material(region);
    if (material == nullptr) {
      throw OptionError("region " + std::to_string(region) + " has no material, which the deck needs");
    }
    if (norm(deck.gravity_m_s2) > 0 && !(material->density_kg_m3 > 0)) {
      throw OptionError("material " + material->name + " has no density, which gravity needs");
    }
  }
}

void write_static_step(const MeshView& mesh, const StaticDeck& deck, Out& out) {
  out.put("*STEP\n*STATIC\n");
  write_displacements(mesh, deck, out);
  write_pressures(mesh, deck, out);
  write_gravity(mesh, deck, out);
  out.put("*NODE FILE\nU, RF\n*EL FILE\nS, E\n*END STEP\n");
}

}  // namespace delvox::mesh_io
