#include "nodes/config/region_section.hpp"

#include <cmath>
#include <optional>
#include <utility>
#include <vector>

#include "nodes/config/config_error.hpp"
#include "nodes/config/task_words.hpp"

namespace rtg::config {
namespace {

using namespace tasks;

constexpr double kLeastSize = 0.1;      // of discs and boxes [m]
constexpr double kUnitWithin = 1e-2;    // legal error of a normal's length, as of [0.71, 0.71]
constexpr double kUnitExactly = 1e-12;  // error of the length that is not corrected

const std::vector<std::string> kDiscKeys{"centre", "radius"};
const std::vector<std::string> kHalfPlaneKeys{"normal", "offset"};
const std::vector<std::string> kBoxKeys{"centre", "size", "theta"};

Disc read_disc(const ConfigNode& section, const std::string& path, const Units& units) {
  FieldReader reader(section, path, kDiscKeys, units);
  Disc disc{point_at(reader, "centre"), 0.0};
  reader.required("radius", length_range(kLeastSize, kMaxPlace, units));
  reader.length("radius", disc.radius, kLeastSize, kMaxPlace);
  return disc;
}

HalfPlane read_half_plane(const ConfigNode& section, const std::string& path, const Units& units) {
  FieldReader reader(section, path, kHalfPlaneKeys, units);
  HalfPlane half{direction_at(reader, "normal"), 0.0};
  const double length = half.normal.norm();
  if (std::abs(length - 1.0) > kUnitWithin)
    throw ConfigError(find(section, "normal")->value.origin, reader.path("normal"),
                      "has length " + number_text(length), "[x, y] of length 1, within 0.01");
  if (std::abs(length - 1.0) > kUnitExactly) half.normal /= length;
  reader.required("offset", "a number, the largest normal . [x, y] in the half-plane [m]");
  reader.length("offset", half.offset, -kMaxPlace, kMaxPlace);
  return half;
}

Polygon read_box(const ConfigNode& section, const std::string& path, const Units& units) {
  FieldReader reader(section, path, kBoxKeys, units);
  const Vector2d centre = point_at(reader, "centre");
  const auto size = reader.lengths("size", 2, kLeastSize, kMaxPlace, "[width, height] in m");
  double theta = 0.0;
  if (const ConfigEntry* given = find(section, "theta"))
    theta = read_number(given->value, reader.path("theta"), -kMaxAngle, kMaxAngle, "rad");
  Polygon polygon = box(size[0], size[1]);
  for (Vector2d& v : polygon.vertices) v = on_grid(rotate(theta, v) + centre);
  return polygon;
}

Polygon read_polygon(const ConfigNode& list, const std::string& path, const Units& units) {
  const std::string legal = "a convex polygon of 3 to 8 vertices [x, y] in m, counter-clockwise";
  Polygon polygon{points_of(list, path, legal, units)};
  if (const auto defect = polygon_defect(polygon.vertices, units.length))
    throw ConfigError(list.origin, path, *defect, legal);
  return polygon;
}

}  // namespace

Region read_region(const FieldReader& reader, const ConfigEntry& entry) {
  const std::string path = reader.path(entry.key);
  if (entry.key == "disc") return read_disc(entry.value, path, reader.units());
  if (entry.key == "half_plane") return read_half_plane(entry.value, path, reader.units());
  if (entry.key == "box") return read_box(entry.value, path, reader.units());
  return read_polygon(entry.value, path, reader.units());
}

ConfigEntry region_entry(const Region& region, const Units& units) {
  if (const auto* disc = std::get_if<Disc>(&region))
    return {"disc", "",
            mapping({{"centre", "", point_node(disc->centre, units)},
                     {"radius", "", length_node(disc->radius, units)}})};
  if (const auto* half = std::get_if<HalfPlane>(&region))
    return {"half_plane", "",
            mapping({{"normal", "", numbers_node({half->normal.x(), half->normal.y()})},
                     {"offset", "", length_node(half->offset, units)}})};
  std::vector<ConfigNode> vertices;
  for (const Vector2d& v : std::get<Polygon>(region).vertices)
    vertices.push_back(point_node(v, units));
  return {"polygon", "", list_node(std::move(vertices))};
}

}  // namespace rtg::config
