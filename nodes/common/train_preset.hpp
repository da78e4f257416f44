#pragma once

#include "nodes/common/train_config.hpp"

namespace rtg {

/// The values that `preset` stands for. `paper` is Table 2, with the defaults of
/// Stable-Baselines3's DQN for what the table leaves open, and uniform mixing.
inline TrainConfig train_preset(TrainPreset preset) {
  TrainConfig config;
  if (preset == TrainPreset::kDefault) return config;
  config.preset = TrainPreset::kPaper;
  config.batch = 512;
  config.learning_rate = 5e-5;
  config.target_sync = 2500;  // 10,000 interactions
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

}  // namespace rtg
