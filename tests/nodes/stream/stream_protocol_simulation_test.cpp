#include <gtest/gtest.h>

#include "nodes/stream/stream_cursor.hpp"
#include "nodes/stream/stream_server.hpp"
#include "tests/support/faulty_network.hpp"
#include "tests/support/seeds.hpp"

// Both ends of the transition stream, as the programs have them, in virtual time, over a network
// that loses, doubles and reorders; consumers come late, are paused and are started again.
namespace rtg::stream {
namespace {

using Cursor = StreamCursor<RowRange>;

constexpr double kStep = 0.01;
constexpr std::int64_t kRowBytes = 1000, kRows = 1500;  // 16 rows per message, 64 per burst

class Simulation {
 public:
  explicit Simulation(std::uint64_t seed, const Cursor::Limits& limits = {})
      : rng_(seed), network_({}, rng_), limits_(limits) {
    begin();
  }

  /// Returns the rows that the consumer has got, in its order, until it was told that it has all.
  std::vector<std::int64_t> run() {
    while (!server_.drained(1, now_)) {
      now_ += kStep;
      if (now_ > 600.0) return {};
      make_rows();
      network_.run(now_);
      for (const RowRange& range : server_.due(now_)) deliver(range);
      if (now_ >= tail_at_) send_tail();
      if (now_ >= paused_until_) consume();
    }
    return got_;
  }

 private:
  void begin() {
    cursor_ = Cursor(limits_);
    got_.clear();
    ++life_;
  }

  void make_rows() {
    const auto more = std::min<std::int64_t>(rng_.below(40), kRows - server_.count());
    server_.append(std::vector<search::Transition>(static_cast<std::size_t>(more)));
    if (server_.count() == kRows) server_.seal();
  }

  void deliver(const RowRange& range) {
    network_.send(now_, [this, range, life = life_] {
      if (life != life_ || now_ < paused_until_) return;  // not there, or its buffer runs over
      for (const auto& [rows, skip] : cursor_.on_rows(range, range, now_))
        for (std::int64_t row = rows.begin + skip; row < rows.end; ++row) got_.push_back(row);
    });
  }

  void send_tail() {
    tail_at_ = now_ + 0.2;
    network_.send(now_, [this, count = server_.count(), sealed = server_.sealed(), life = life_] {
      if (life == life_ && now_ >= paused_until_) cursor_.on_tail(count, sealed);
    });
  }

  void consume() {
    while (const auto ack = cursor_.due(now_)) {
      network_.send(now_, [this, ack, life = life_] {
        server_.on_ack({life, ack->cursor, ack->credit, ack->missing}, now_);
      });
    }
    if (rng_.uniform(0, 1) < 0.001 && !cursor_.complete()) begin();
    if (rng_.uniform(0, 1) < 0.001) paused_until_ = now_ + rng_.uniform(0.0, 5.0);
  }

  Rng rng_;
  testing::FaultyNetwork network_;
  Cursor::Limits limits_;
  double now_ = 0.0, tail_at_ = 0.0, paused_until_ = 0.0;
  std::int64_t life_ = 0;
  StreamServer server_{{}, kRowBytes};
  Cursor cursor_;
  std::vector<std::int64_t> got_;
};

std::vector<std::int64_t> all_rows() {
  std::vector<std::int64_t> rows(kRows);
  std::iota(rows.begin(), rows.end(), 0);
  return rows;
}

TEST(StreamProtocol, EveryRowArrivesOnceAndInOrderWhateverTheNetworkDoes) {
  for (const std::uint64_t seed : testing::seeds(10000))
    ASSERT_EQ(Simulation(seed).run(), all_rows()) << testing::replay(seed);
}

// The network does lose rows: a consumer that asks for none of them waits for ever.
TEST(StreamProtocol, WithoutQuestionsRowsAreMissing) {
  EXPECT_NE(Simulation(1, {.most_ranges = 0}).run(), all_rows());
}

}  // namespace
}  // namespace rtg::stream
