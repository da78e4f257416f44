#include "nodes/bus/run_key.hpp"

#include <gtest/gtest.h>
#include <sys/stat.h>

#include <fstream>
#include <stdexcept>

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
  std::ofstream(file) << std::string(64, '0') << " test\n";
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
  const std::string hex(64, 'a');
  const std::filesystem::path file = folder.path / "run.key";
  const std::string legal = "; legal: the key file of a run, which its owner alone can read";
  EXPECT_EQ(refusal(file), file.string() + ": no such file" + legal);
  EXPECT_EQ(refusal("/dev/zero"), "/dev/zero: is no regular file" + legal);
  for (const std::string& text :
       {std::string(), hex, hex + "\n", hex + " \n", hex + " test", "a" + hex + " test\n",
        hex.substr(1) + " test\n", hex + " test\nmore\n", "xyz" + hex + " test\n"}) {
    std::ofstream(file) << text;
    chmod(file.c_str(), 0600);
    EXPECT_EQ(refusal(file),
              file.string() +
                  ": is no key file; legal: a line of 64 hexadecimal digits, a space and the run's "
                  "name")
        << text;
  }
  std::ofstream(file) << hex << " test\n";
  EXPECT_EQ(refusal(file), "");
  chmod(file.c_str(), 0640);
  EXPECT_EQ(refusal(file), file.string() +
                               ": others can read or write it, or it is another user's (chmod 600 "
                               "closes it)" +
                               legal);
}

}  // namespace
}  // namespace rtg::bus
