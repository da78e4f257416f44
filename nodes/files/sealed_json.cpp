#include "nodes/files/sealed_json.hpp"

#include <span>

#include "nodes/files/sha256.hpp"

namespace rtg::files {

std::string sealed_json(std::string object) {
  object.pop_back();  // its }
  object += R"(,"sha256":")";
  const auto* begin = reinterpret_cast<const std::uint8_t*>(object.data());
  const std::string digits = Sha256().add(std::span(begin, object.size())).hex();
  return object + digits + "\"}";
}

}  // namespace rtg::files
