// A fuzz target without libFuzzer, as ctest runs it on every commit:
//
//   replay COUNT            its seeds, and COUNT inputs made from them, the same in every run
//   replay FILE...          the inputs in these files
//   replay --seeds FOLDER   writes the seeds, for libFuzzer
//
// The input in work is in the file PROGRAM.input until it is done; so a crash leaves its
// reproducer.
#include <array>
#include <charconv>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <memory>

#include "core/math/rng.hpp"
#include "tests/fuzz/target.hpp"

namespace rtg::fuzz {
namespace {

using namespace std::literals;

constexpr int kLongestStretch = 40;  // bytes

/// What parsers of texts have cases for, and what numbers in bytes are at their bounds.
constexpr std::array<std::string_view, 30> kWords{
    "[",  "]",     "{",    "}",  ": ", ", ",    "\n",   "\n  - ", "- ",   "'",
    "\"", "#",     "&a ",  "*a", "!",  "!!int", "---",  "...",    "? ",   "| ",
    "> ", "1e999", ".nan", "-1", "0",  "\t",    "\xff", "\\",     "true", "\x1e"};
constexpr std::array kNumbers{"\0\0\0\0"sv, "\xff\xff\xff\xff"sv, "\x7f\xff\xff\xff"sv,
                              "\x80\0\0\0"sv, "\x7f\xf8\0\0\0\0\0\0"sv};

std::size_t below(Rng& rng, std::size_t bound) {
  return static_cast<std::size_t>(rng.below(static_cast<int>(bound)));
}

std::string_view token(Rng& rng) {
  if (rng.below(4) == 0) return kNumbers[below(rng, kNumbers.size())];
  return kWords[below(rng, kWords.size())];
}

/// Returns a byte in the place of `c`, for a digit another digit: the text may stay legal.
char other(char c, Rng& rng) {
  const bool is_digit = '0' <= c && c <= '9';
  return static_cast<char>(is_digit ? '0' + rng.below(10) : rng.below(256));
}

/// Makes one change: of a byte or a bit, a token put in, a stretch left out or put in once more, or
/// the end of another seed in place of its own.
void change(std::string& input, const std::vector<Bytes>& all, Rng& rng) {
  const std::size_t at = below(rng, input.size() + 1);
  const std::size_t length = below(rng, kLongestStretch);
  switch (rng.below(7)) {
    case 0:
      if (at < input.size()) input[at] = other(input[at], rng);
      break;
    case 1:
      if (at < input.size()) input[at] = static_cast<char>(input[at] ^ 1 << rng.below(8));
      break;
    case 2:
      input.insert(at, token(rng));
      break;
    case 3: {
      const std::string_view put = token(rng);
      input.replace(at, put.size(), put);
      break;
    }
    case 4:
      input.erase(at, length);
      break;
    case 5:
      input.insert(below(rng, input.size() + 1), input.substr(at, length));
      break;
    default: {
      const Bytes& seed = all[below(rng, all.size())];
      const auto from = static_cast<std::ptrdiff_t>(below(rng, seed.size() + 1));
      input.replace(at, std::string::npos, std::string(seed.begin() + from, seed.end()));
    }
  }
}

/// Runs inputs, and keeps the one in work on disk.
class Replay {
 public:
  explicit Replay(std::filesystem::path file) : file_(std::move(file)) {}
  ~Replay() { std::filesystem::remove(file_); }

  void run(const std::string& input) const {
    std::ofstream(file_, std::ios::binary) << input;
    // An allocation of just this size: AddressSanitizer sees a read behind the end.
    const auto bytes = std::make_unique<std::uint8_t[]>(input.size());
    std::copy(input.begin(), input.end(), bytes.get());
    LLVMFuzzerTestOneInput(bytes.get(), input.size());
  }

 private:
  std::filesystem::path file_;
};

std::string text(const Bytes& bytes) { return {bytes.begin(), bytes.end()}; }

void run_all(int count, const Replay& replay) {
  const std::vector<Bytes> all = seeds();
  for (const Bytes& seed : all) replay.run(text(seed));
  Rng rng(1);
  for (int k = 0; k < count; ++k) {
    std::string input = text(all[static_cast<std::size_t>(k) % all.size()]);
    do change(input, all, rng);
    while (rng.below(3) == 0);
    replay.run(input);
  }
}

void write_seeds(const std::filesystem::path& folder) {
  std::filesystem::create_directories(folder);
  int number = 0;
  for (const Bytes& seed : seeds())
    std::ofstream(folder / ("seed." + std::to_string(number++)), std::ios::binary) << text(seed);
}

void run_file(const std::filesystem::path& file, const Replay& replay) {
  std::ifstream stream(file, std::ios::binary);
  require(stream.good(), file.string() + " can be read");
  replay.run({std::istreambuf_iterator<char>(stream), {}});
}

}  // namespace
}  // namespace rtg::fuzz

int main(int argc, char** argv) {
  using namespace rtg::fuzz;
  const std::vector<std::string> words(argv + 1, argv + argc);
  if (words.size() == 2 && words[0] == "--seeds") return write_seeds(words[1]), 0;
  const Replay replay{std::string(argv[0]) + ".input"};
  int count = 0;
  if (words.size() == 1 &&
      std::from_chars(words[0].data(), words[0].data() + words[0].size(), count).ec == std::errc{})
    return run_all(count, replay), 0;
  for (const std::string& file : words) run_file(file, replay);
}
