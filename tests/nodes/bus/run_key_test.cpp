#include "nodes/bus/run_key.hpp"

#include <gtest/gtest.h>
#include <sys/stat.h>

#include <fstream>
#include <stdexcept>

#include "nodes/files/regular_file.hpp"
#include "tests/support/folder.hpp"

namespace rtg::bus {
namespace {

using Bytes = std::vector<std::uint8_t>;

TEST(RunKey, IsReadAsItWasWritten) {
  const testing::Folder folder;
  const RunKey written = RunKey::random("a run, of two words");
  written.write(folder.path / "run.key");
  const RunKey read = RunKey::read(folder.path / "run.key");
  EXPECT_EQ(read.name(), "a run, of two words");
  Bytes bytes{1, 2, 3};
  written.seal("TAIL", bytes);
  const auto message = read.opened("TAIL", bytes);
  ASSERT_TRUE(message);
  EXPECT_EQ(Bytes(message->begin(), message->end()), (Bytes{1, 2, 3}));
}

TEST(RunKey, TwoKeysOfOneNameDiffer) {
  Bytes bytes{1, 2, 3};
  RunKey::random("test").seal("TAIL", bytes);
  EXPECT_FALSE(RunKey::random("test").opened("TAIL", bytes));
}

TEST(RunKey, TheTagIsKeyedBlake2bOverChannelAndBytes) {
  const testing::Folder folder;
  const std::filesystem::path file = folder.path / "run.key";
  // hashlib.blake2b(b"\0test", key=bytes(32), digest_size=16)
  std::ofstream(file) << std::string(64, '0') << " 482e307ddd8ca58ea83ba528b3038184 test\n";
  chmod(file.c_str(), 0600);
  Bytes bytes{1, 2, 3};
  RunKey::read(file).seal("TAIL", bytes);
  // hashlib.blake2b(b"TAIL\0\1\2\3", key=bytes(32), digest_size=16)
  const Bytes tag{0x1d, 0x58, 0xbd, 0x8f, 0x8,  0xd3, 0xed, 0x21,
                  0xc4, 0xc8, 0xa9, 0x16, 0x79, 0x29, 0xac, 0x47};
  EXPECT_EQ(Bytes(bytes.begin() + 3, bytes.end()), tag);
}

/// Returns why `file` is refused as a key file.
std::string refusal(const std::filesystem::path& file) {
  try {
    RunKey::read(file);
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return "";
}

TEST(RunKey, FilesThatAreNoKeysOrNoSecretsAreNamed) {
  const testing::Folder folder;
  const std::filesystem::path file = folder.path / "run.key";
  const std::string legal =
      "; legal: the key file of a run, which its owner alone can read, or none, for a new key";
  EXPECT_EQ(refusal(file), file.string() + ": no such file" + legal);
  EXPECT_EQ(refusal("/dev/zero"), "/dev/zero: is no regular file" + legal);
  RunKey::random("test").write(file);
  const std::string right = files::read_regular(file, 4096).text;
  for (const std::string& text :
       {std::string(), right.substr(0, 64), right.substr(0, 98), right.substr(0, 97) + "\n",
        right.substr(0, right.size() - 1), right + "more\n", "a" + right, right.substr(1)}) {
    std::ofstream(file) << text;
    EXPECT_EQ(refusal(file),
              file.string() + ": is no key file, or was changed since it was written" + legal)
        << text;
  }
  std::ofstream(file) << right;
  EXPECT_EQ(refusal(file), "");
  chmod(file.c_str(), 0640);
  EXPECT_EQ(refusal(file), file.string() +
                               ": others can read or write it, or it is another user's (chmod 600 "
                               "closes it)" +
                               legal);
}

TEST(RunKey, EveryFlippedBitOfAFileIsSeen) {
  const testing::Folder folder;
  const std::filesystem::path file = folder.path / "run.key";
  RunKey::random("a run").write(file);
  const std::string right = files::read_regular(file, 4096).text;
  for (std::size_t bit = 0; bit < 8 * right.size(); ++bit) {
    std::string text = right;
    text[bit / 8] = static_cast<char>(text[bit / 8] ^ 1 << bit % 8);
    std::ofstream(file) << text;
    EXPECT_NE(refusal(file), "") << bit;
  }
}

}  // namespace
}  // namespace rtg::bus
