// The file with the key of a run.
#include "nodes/bus/run_key.hpp"

#include <stdexcept>

#include "tests/fuzz/scratch_file.hpp"
#include "tests/fuzz/target.hpp"

namespace rtg::fuzz {
namespace {

void check(std::span<const std::uint8_t> bytes) {
  static const ScratchFile file("run.key");
  file.write(bytes);
  const bus::RunKey key = bus::RunKey::read(file.path);
  const Bytes message{1, 2, 3};
  Bytes sealed = message;
  key.seal("CHANNEL", sealed);
  key.write(file.path);
  const bus::RunKey again = bus::RunKey::read(file.path);
  require(again.name() == key.name(), "the name is read back");
  require(again.opened("CHANNEL", sealed).has_value(), "the secret is read back");
  require(!again.opened("CHANNEl", sealed), "a message is of its channel");
}

}  // namespace

std::vector<Bytes> seeds() {
  const std::string digits = "00112233445566778899aabbccddeeffffeeddccbbaa99887766554433221100";
  return {bytes_of(digits + " b5e5343d620ccc46ff3699b7d3d44f92 run\n"),
          bytes_of(digits + " b6e9cad6ff458c9ec31f506809dc725a two words\n"),
          bytes_of(digits + "\n")};
}

}  // namespace rtg::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  try {
    rtg::fuzz::check({data, size});
  } catch (const std::invalid_argument& error) {
    const std::string message = error.what();
    rtg::fuzz::require(message.find("run.key: ") != std::string::npos &&
                           message.find("; legal: ") != std::string::npos,
                       "the message names the file and what is legal: " + message);
  }
  return 0;
}
