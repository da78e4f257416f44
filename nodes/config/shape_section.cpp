#include "nodes/config/shape_section.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <utility>
#include <vector>

#include "core/world/outline.hpp"
#include "nodes/config/config_error.hpp"
#include "nodes/config/field_reader.hpp"
#include "nodes/config/field_writer.hpp"
#include "nodes/config/task_words.hpp"

namespace rtg::config {
namespace {

using tasks::Units;
using Kind = ConfigNode::Kind;

// In units of the task.
constexpr double kMaxSize = 1000.0;      // largest length or coordinate
constexpr double kMinSize = 0.005;       // smallest length
constexpr double kMaxRadius = 100.0;     // largest bounding radius
constexpr double kCentredWithin = 1e-9;  // rounding error of the centroid / (1 + bounding radius)
constexpr std::size_t kMaxRing = 64;     // vertices of a simple polygon
constexpr std::size_t kMaxParts = 16;

const std::vector<std::string> kForms{"box", "regular", "vertices", "disc", "parts"};
const std::vector<std::string> kShapeKeys{"box",   "regular",  "vertices", "disc",
                                          "parts", "rounding", "grown"};
const std::vector<std::string> kPartKeys{"box", "regular",  "vertices", "disc",
                                         "at",  "rounding", "grown"};
const std::vector<std::string> kRegularKeys{"sides", "radius"};
const std::string kShapeLegal =
    "{box: [width, height]}, {regular: {sides: 3 to 8, radius: r}}, {vertices: [[x, y], ...]}, "
    "{disc: radius} or {parts: [...]}, lengths in m";
const std::string kVerticesLegal =
    "a simple polygon of 3 to 64 vertices [x, y] in m, counter-clockwise";

std::string metres(double length, const Units& units) { return length_text(length, units) + " m"; }

/// Returns the parts with their centroid at the origin.
std::vector<Part> centred(std::vector<Part> parts) {
  // The moments alone: a Shape of many round parts takes a while.
  const Vector2d centroid =
      (parts.size() == 1 ? Shape(parts).moments() : union_moments(parts)).centroid;
  double reach = 0.0;
  for (const Part& part : parts) reach = std::max(reach, reach_from(Vector2d::Zero(), part));
  if (centroid.norm() <= kCentredWithin * (1.0 + reach)) return parts;
  return placed(std::move(parts), 0.0, -centroid);
}

/// Returns the parts with their numbers rounded, so that their text reads back to the bit.
std::vector<Part> on_grid(std::vector<Part> parts, const Units& units) {
  for (Part& part : parts) {
    for (Vector2d& v : part.core.vertices) v = {units.on_grid(v.x()), units.on_grid(v.y())};
    part.radius = units.on_grid(part.radius);
  }
  return parts;
}

/// Throws ConfigError if `defect` is one.
void refuse(const std::optional<std::string>& defect, const std::string& origin,
            const std::string& path, const std::string& legal = kVerticesLegal) {
  if (defect) throw ConfigError(origin, path, *defect, legal);
}

Polygon read_box(const FieldReader& reader) {
  const auto size = reader.lengths("box", 2, kMinSize, kMaxSize, "[width, height] in m");
  return box(size[0], size[1]);
}

Polygon read_regular(const ConfigNode& section, const std::string& path, const Units& units) {
  FieldReader reader(section, path, kRegularKeys, units);
  int sides = 0;
  double radius = 0.0;
  reader.required("sides", "an integer from 3 to 8");
  reader.required("radius", "the distance of the corners from the centre [m]");
  reader.integer("sides", sides, 3, static_cast<int>(kMaxVertices));
  reader.length("radius", radius, kMinSize, kMaxSize);
  return regular_polygon(sides, radius);
}

std::vector<Vector2d> read_ring(const ConfigNode& list, const std::string& path,
                                const Units& units) {
  std::vector<Vector2d> ring = points_of(list, path, kVerticesLegal, units);
  if (ring.size() < 3 || ring.size() > kMaxRing)
    refuse("has " + std::to_string(ring.size()) + " vertices", list.origin, path);
  return ring;
}

/// Reads a simple polygon, as one convex polygon or several.
std::vector<Polygon> read_vertices(const ConfigNode& list, const std::string& path,
                                   const Units& units) {
  const std::vector<Vector2d> ring = read_ring(list, path, units);
  if (!polygon_defect(ring)) return {Polygon{ring}};
  for (std::size_t k = 0; k < ring.size(); ++k)
    if ((ring[(k + 1) % ring.size()] - ring[k]).norm() < kMinSize)
      refuse("edge at vertex " + std::to_string(k) + " is shorter than " + metres(kMinSize, units),
             list.origin, path);
  if (const std::optional<Vector2d> x = self_contact(ring))
    refuse("crosses or touches itself at [" + length_text(x->x(), units) + ", " +
               length_text(x->y(), units) + "]",
           list.origin, path);
  if (area_integrals(ring).area < 0.0)
    refuse("is clockwise; list the vertices counter-clockwise", list.origin, path);
  std::vector<Polygon> pieces = convex_pieces(ring);
  if (pieces.empty()) refuse("has no area", list.origin, path);
  if (pieces.size() > kMaxParts)
    refuse("splits into " + std::to_string(pieces.size()) + " convex parts", list.origin, path,
           "a polygon that splits into at most " + std::to_string(kMaxParts));
  for (const Polygon& piece : pieces)
    if (const std::optional<std::string> defect = polygon_defect(piece.vertices, units.length))
      refuse("has a convex piece that " + *defect, list.origin, path);
  return pieces;
}

/// Returns the polygon whose edges lie `radius` within those of `polygon`. Throws ConfigError if it
/// is too narrow for that.
Polygon inset(const Polygon& polygon, double radius, const ConfigNode& node,
              const std::string& path, const Units& units) {
  Polygon core = offset_polygon(polygon, -radius);
  for (std::size_t k = 0; k < core.size(); ++k) {
    const std::size_t next = (k + 1) % core.size();
    const Vector2d edge = polygon.vertices[next] - polygon.vertices[k];
    if (edge.dot(core.vertices[next] - core.vertices[k]) < kMinSize * edge.norm())
      throw ConfigError(
          node.origin, path, metres(radius, units) + " rounds off a whole edge",
          "a radius that leaves " + metres(kMinSize, units) + " of each edge straight");
  }
  return core;
}

/// Returns the only key of `section` that tells a form. Throws ConfigError if there are none or
/// several.
const ConfigEntry& form_of(const ConfigNode& section, const std::string& path) {
  const ConfigEntry* form = nullptr;
  int count = 0;
  for (const std::string& key : kForms)
    if (const ConfigEntry* entry = find(section, key)) {
      form = entry;
      ++count;
    }
  if (count != 1)
    throw ConfigError(section.origin, path,
                      count == 0 ? "tells no form" : "has more than one of the keys of a form",
                      kShapeLegal);
  return *form;
}

/// Reads a shape or a part of one, without parts of its own, in its own frame.
std::vector<Part> read_simple(const FieldReader& reader, const ConfigEntry& form) {
  const ConfigNode &section = reader.section(), &value = form.value;
  const std::string path = reader.path(form.key);
  const ConfigEntry *rounding = find(section, "rounding"), *grown = find(section, "grown");
  const ConfigEntry* margin = rounding ? rounding : grown;
  if (margin && (form.key == "disc" || (rounding && grown)))
    throw ConfigError(margin->value.origin, reader.path(margin->key),
                      form.key == "disc" ? "a disc has no corners" : "is given beside 'grown'",
                      "one of rounding, grown, at a polygon");
  if (form.key == "disc")
    return {disc(read_length(value, path, kMinSize, kMaxRadius, reader.units()))};
  std::vector<Polygon> pieces;
  if (form.key == "vertices")
    pieces = read_vertices(value, path, reader.units());
  else
    pieces = {form.key == "box" ? read_box(reader) : read_regular(value, path, reader.units())};
  for (const Polygon& piece : pieces)
    refuse(polygon_defect(piece.vertices, reader.units().length), value.origin, path);
  if (!margin) {
    std::vector<Part> parts;
    for (Polygon& piece : pieces) parts.push_back({std::move(piece)});
    return parts;
  }
  const std::string margin_path = reader.path(margin->key);
  if (pieces.size() > 1)
    throw ConfigError(margin->value.origin, margin_path, "the polygon is not convex",
                      "convex polygons only; parts of a shape may have it");
  const double radius =
      read_length(margin->value, margin_path, kMinSize, kMaxRadius, reader.units());
  if (rounding)
    return {{inset(pieces[0], radius, margin->value, margin_path, reader.units()), radius}};
  return {{std::move(pieces[0]), radius}};
}

/// Reads a part of a shape, in the frame of the shape.
std::vector<Part> read_part(const ConfigNode& section, const std::string& path,
                            const Units& units) {
  const FieldReader reader(section, path, kPartKeys, units);
  std::vector<Part> parts = read_simple(reader, form_of(section, path));
  const ConfigEntry* at = find(section, "at");
  if (!at) return parts;
  if (at->value.kind == Kind::kList && at->value.items.size() == 2)
    return placed(std::move(parts), 0.0, point_at(reader, "at"));
  const Pose where = reader.pose("at", kMaxSize, "[x, y] or [x, y, theta] in m and rad");
  return placed(std::move(parts), where.theta, where.position());
}

std::vector<Part> read_parts(const ConfigNode& list, const std::string& path, const Units& units) {
  const std::string legal = "a list of 1 to 16 parts";
  if (list.kind != Kind::kList)
    throw ConfigError(list.origin, path, in_words(list) + " is not a list", legal);
  std::vector<Part> parts;
  for (std::size_t n = 0; n < list.items.size(); ++n)
    for (Part& part : read_part(list.items[n], path + '.' + std::to_string(n), units))
      parts.push_back(std::move(part));
  if (parts.empty() || parts.size() > kMaxParts)
    throw ConfigError(list.origin, path, "has " + std::to_string(parts.size()) + " convex parts",
                      legal);
  if (!in_one_piece(parts))
    throw ConfigError(list.origin, path, "is in several pieces",
                      "parts that overlap or share an edge");
  return parts;
}

/// Returns the section of a polygon as that of a shape or of a part.
ConfigEntry polygon_entry(const Polygon& polygon, const Units& units) {
  const double width = 2.0 * polygon.vertices[0].x(), height = 2.0 * polygon.vertices[0].y();
  if (polygon == box(-width, -height)) return {"box", "", lengths_node({-width, -height}, units)};
  const int sides = static_cast<int>(polygon.size());
  const double radius = polygon.vertices[0].x();
  if (polygon == regular_polygon(sides, radius)) {
    ConfigNode keys = map_node();
    keys.entries.push_back({"sides", "", token_node(std::to_string(sides))});
    keys.entries.push_back({"radius", "", length_node(radius, units)});
    return {"regular", "", std::move(keys)};
  }
  std::vector<ConfigNode> vertices;
  for (const Vector2d& v : polygon.vertices) vertices.push_back(point_node(v, units));
  return {"vertices", "", list_node(std::move(vertices))};
}

ConfigNode part_node(const Part& part, const Units& units) {
  ConfigNode node = map_node();
  const ConfigNode radius = length_node(part.radius, units);
  if (part.is_disc()) {
    const Vector2d& centre = part.core.vertices[0];
    node.entries.push_back({"disc", "", radius});
    if (!centre.isZero(0.0)) node.entries.push_back({"at", "", point_node(centre, units)});
    return node;
  }
  node.entries.push_back(polygon_entry(part.core, units));
  if (part.radius > 0.0) node.entries.push_back({"grown", "", radius});
  return node;
}

}  // namespace

Shape read_shape(const ConfigNode& section, const std::string& path, const Units& units) {
  if (section.kind != Kind::kMap)
    throw ConfigError(section.origin, path, in_words(section) + " is not a mapping", kShapeLegal);
  const FieldReader reader(section, path, kShapeKeys, units);
  const ConfigEntry& form = form_of(section, path);
  const bool compound = form.key == "parts";
  for (const char* key : {"rounding", "grown"})
    if (const ConfigEntry* margin = find(section, key); margin && compound)
      throw ConfigError(margin->value.origin, reader.path(key), "is given beside parts",
                        "the key in the parts");
  std::vector<Part> parts = centred(compound ? read_parts(form.value, reader.path(form.key), units)
                                             : read_simple(reader, form));
  if (form.key != "regular" || find(section, "rounding")) parts = on_grid(std::move(parts), units);
  Shape shape(std::move(parts));
  if (shape.radius() > kMaxRadius)
    refuse("reaches " + std::to_string(std::lround(shape.radius() * units.length)) +
               " m from its centre",
           form.value.origin, path,
           "a shape within " + metres(kMaxRadius, units) + " of its centre");
  return shape;
}

ConfigNode shape_node(const Shape& shape, const Units& units) {
  if (shape.parts().size() == 1) return part_node(shape.parts()[0], units);
  std::vector<ConfigNode> parts;
  for (const Part& part : shape.parts()) parts.push_back(part_node(part, units));
  ConfigNode node = map_node();
  node.entries.push_back({"parts", "", list_node(std::move(parts))});
  return node;
}

}  // namespace rtg::config
