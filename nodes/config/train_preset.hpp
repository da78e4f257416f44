#pragma once

#include "nodes/config/train_config.hpp"

namespace rtg::config {

/// Returns the values of `preset`. `paper` is Table 2, with uniform mixing of offline and online
/// transitions. Table 2 leaves two values open:
///
///  - The decay of exploration is the default of Stable-Baselines3.
///  - The target network is copied every 250 gradient steps (1,000 interactions). One copy carries
///    the value of success back by about one push, and plans have 20 pushes. This gives 350 copies
///    within the budget. The default of Stable-Baselines3, 2,500 gradient steps, would give 35.
inline TrainConfig train_preset(TrainPreset preset) {
  TrainConfig config;
  if (preset == TrainPreset::kDefault) return config;
  config.preset = TrainPreset::kPaper;
  config.batch = 512;
  config.learning_rate = 5e-5;
  config.target_sync = 250;
  config.target_rate = 1.0;
  config.target_acts = false;
  config.averaging_rate = 1.0;
  config.discount = 0.0;
  config.offline_share = -1.0;
  config.recent_share = 0.0;
  config.clipped_double_q = false;
  config.network = Network::kPlain;
  config.clip_targets = config.value_bounds = false;
  config.epsilon_start = 1.0;
  config.epsilon_end = 0.05;
  config.epsilon_share = 0.1;
  config.nearby_share = 0.0;
  config.leave_loops = false;
  config.symmetry = false;
  config.start_jitter = 0.0;
  config.eval_every = 10000;
  config.stop_at_success = 0.0;
  return config;
}

}  // namespace rtg::config
