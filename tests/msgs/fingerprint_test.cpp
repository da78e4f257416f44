#include <gtest/gtest.h>
#include <rtg_msgs/wire_fields.hpp>

// A failure here is a change of the wire: processes of the two versions do not understand each
// other. If it is meant, copy the printed value and say so under "Wire" in CHANGELOG.md.
namespace rtg_msgs {
namespace {

template <class Msg>
std::string fingerprint() {
  char text[20];
  std::snprintf(text, sizeof text, "%016lx", static_cast<unsigned long>(Msg::getHash()));
  return text;
}

TEST(Fingerprint, IsPinned) {
  EXPECT_EQ(fingerprint<header_t>(), "8959133396786f27");
  EXPECT_EQ(fingerprint<worker_beat_t>(), "bc80f2eca7427f4c");
  EXPECT_EQ(fingerprint<reverse_job_t>(), "f57507c0eb56c649");
  EXPECT_EQ(fingerprint<reverse_result_t>(), "46f8d0e6601ad130");
  EXPECT_EQ(fingerprint<replay_job_t>(), "865ba9ac6170c733");
  EXPECT_EQ(fingerprint<replay_result_t>(), "ff4f8e7111c6e8dc");
  EXPECT_EQ(fingerprint<transition_batch_t>(), "afecb8d7987eaaf4");
  EXPECT_EQ(fingerprint<stream_tail_t>(), "2ddf946a6a78351a");
  EXPECT_EQ(fingerprint<stream_ack_t>(), "fdfa539ba7fa5dc5");
  EXPECT_EQ(fingerprint<search_progress_t>(), "51d8b1e2e943c17c");
  EXPECT_EQ(fingerprint<node_status_t>(), "c2dc4832992b3d39");
}

}  // namespace
}  // namespace rtg_msgs
