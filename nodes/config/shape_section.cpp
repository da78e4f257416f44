#include "nodes/config/shape_section.hpp"

#include <cmath>
#include <optional>
#include <utility>
#include <vector>

#include "nodes/config/config_error.hpp"
#include "nodes/config/field_reader.hpp"
#include "nodes/config/field_writer.hpp"
#include "nodes/config/task_words.hpp"

namespace rtg::config {
namespace {

using Kind = ConfigNode::Kind;

constexpr double kMaxSize = 1000.0;      // largest length or coordinate [m]
constexpr double kMinSize = 0.005;       // smallest length [m]
constexpr double kMaxRadius = 100.0;     // largest bounding radius [m]
constexpr double kCentredWithin = 1e-9;  // rounding error of the centroid / bounding radius

const std::vector<std::string> kShapes{"box", "regular", "vertices"};
const std::vector<std::string> kRegularKeys{"sides", "radius"};
const std::string kShapeLegal =
    "{box: [width, height]}, {regular: {sides: 3 to 8, radius: m}} or {vertices: [[x, y], ...]}";
const std::string kVerticesLegal =
    "a convex polygon of 3 to 8 vertices [x, y], counter-clockwise, within 100 m of its centre";

/// Returns `shape`. Throws ConfigError if it is not legal.
Polygon checked(Polygon shape, const std::string& origin, const std::string& path) {
  std::optional<std::string> defect = polygon_defect(shape.vertices);
  if (!defect && bounding_radius(shape) > kMaxRadius)
    defect =
        "reaches " + std::to_string(std::lround(bounding_radius(shape))) + " m from its centre";
  if (defect) throw ConfigError(origin, path, *defect, kVerticesLegal);
  return shape;
}

Polygon read_regular(const ConfigNode& section, const std::string& path) {
  FieldReader reader(section, path, kRegularKeys);
  int sides = 0;
  double radius = 0.0;
  reader.required("sides", "an integer from 3 to 8");
  reader.required("radius", "the distance of the corners from the centre [m]");
  reader.integer("sides", sides, 3, static_cast<int>(kMaxVertices));
  reader.number("radius", radius, kMinSize, kMaxSize);
  return regular_polygon(sides, radius);
}

Polygon read_vertices(const ConfigNode& list, const std::string& path) {
  if (list.kind != Kind::kList)
    throw ConfigError(list.origin, path, in_words(list) + " is not a list", kVerticesLegal);
  Polygon shape;
  for (const ConfigNode& item : list.items) {
    if (item.kind != Kind::kList || item.items.size() != 2)
      throw ConfigError(item.origin, path, in_words(item) + " is not a vertex [x, y]",
                        kVerticesLegal);
    shape.vertices.emplace_back(read_number(item.items[0], path, -kMaxSize, kMaxSize),
                                read_number(item.items[1], path, -kMaxSize, kMaxSize));
  }
  shape = checked(std::move(shape), list.origin, path);
  const bool is_centred = moments(shape).centroid.norm() <= kCentredWithin * bounding_radius(shape);
  return is_centred ? shape : checked(centred(shape), list.origin, path);
}

ConfigNode keyed(const std::string& key, ConfigNode value) {
  ConfigNode node = map_node();
  node.entries.push_back({key, "", std::move(value)});
  return node;
}

}  // namespace

Polygon read_shape(const ConfigNode& section, const std::string& path) {
  if (section.kind != Kind::kMap || section.entries.size() != 1)
    throw ConfigError(section.origin, path,
                      section.kind == Kind::kMap
                          ? "has " + std::to_string(section.entries.size()) + " keys instead of one"
                          : in_words(section) + " is not a mapping",
                      kShapeLegal);
  const FieldReader reader(section, path, kShapes);
  const ConfigEntry& only = section.entries.front();
  if (only.key == "vertices") return read_vertices(only.value, reader.path(only.key));
  if (only.key == "regular")
    return checked(read_regular(only.value, reader.path(only.key)), only.value.origin, path);
  const auto size = reader.numbers("box", 2, kMinSize, kMaxSize, "[width, height] in m");
  return checked(box(size[0], size[1]), only.value.origin, path);
}

ConfigNode shape_node(const Polygon& shape) {
  const double width = 2.0 * shape.vertices[0].x(), height = 2.0 * shape.vertices[0].y();
  if (shape == box(-width, -height))
    return keyed("box",
                 list_node({token_node(number_text(-width)), token_node(number_text(-height))}));
  const int sides = static_cast<int>(shape.size());
  const double radius = shape.vertices[0].x();
  if (shape == regular_polygon(sides, radius)) {
    ConfigNode keys = map_node();
    keys.entries.push_back({"sides", "", token_node(std::to_string(sides))});
    keys.entries.push_back({"radius", "", token_node(number_text(radius))});
    return keyed("regular", std::move(keys));
  }
  std::vector<ConfigNode> vertices;
  for (const Vector2d& v : shape.vertices) vertices.push_back(point_node(v));
  return keyed("vertices", list_node(std::move(vertices)));
}

}  // namespace rtg::config
