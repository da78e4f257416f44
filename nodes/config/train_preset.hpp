#pragma once

#include "nodes/config/train_config.hpp"

namespace rtg::config {

/// The values that `preset` stands for. `paper` is Table 2 with uniform mixing. The table leaves
/// open how often the target network is copied and how exploration decays. A copy hands the value
/// of success back by about one push: every 250 gradient steps (1,000 interactions) makes it 350
/// times within the budget, where plans have 20 pushes; the 2,500 steps of Stable-Baselines3's
/// default would make it 35 times. Exploration decays as by default there.
inline TrainConfig train_preset(TrainPreset preset) {
  TrainConfig config;
  if (preset == TrainPreset::kDefault) return config;
  config.preset = TrainPreset::kPaper;
  config.batch = 512;
  config.learning_rate = 5e-5;
  config.target_sync = 250;
  config.target_rate = 1.0;
  config.target_acts = false;
  config.policy_rate = 1.0;
  config.discount = 0.0;
  config.offline_share = -1.0;
  config.recent_share = 0.0;
  config.cautious = false;
  config.dueling = config.layer_norm = config.small_head = false;
  config.clip_targets = config.value_bounds = false;
  config.epsilon_start = 1.0;
  config.epsilon_end = 0.05;
  config.epsilon_share = 0.1;
  config.nearby_share = 0.0;
  config.leave_loops = false;
  config.start_jitter = 0.0;
  config.eval_every = 10000;
  config.stop_at_success = 0.0;
  config.reduced_precision = false;
  return config;
}

}  // namespace rtg::config
