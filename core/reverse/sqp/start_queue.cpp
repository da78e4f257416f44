#include "core/reverse/sqp/start_queue.hpp"

#include <algorithm>

namespace rtg::reverse {

template <class T>
StartQueue<T>::StartQueue(const ReverseProblem& like)
    : problem_(like), warm_(problem_), x_(problem_.energy, like.sub_steps), warm_x_(x_) {}

template <class T>
void StartQueue<T>::begin(std::span<const ReverseProblem* const> problems,
                          std::span<const Iterate> starts) {
  problems_ = problems;
  starts_ = starts;
  next_ = handed_out_ = 0;
  ready_.clear();
}

template <class T>
int StartQueue<T>::take(int l, Trajectory<T>& x) {
  for (;;) {
    if (handed_out_ == ready_.size()) prepare();
    if (ready_.empty()) return -1;
    const auto from = static_cast<int>(handed_out_);
    const int job = ready_[handed_out_++];
    if (job < 0) continue;
    x.copy_lane(l, x_, from);
    return job;
  }
}

template <class T>
void StartQueue<T>::prepare() {
  ready_.clear();
  handed_out_ = 0;
  Mask<T> wanted(false);
  for (int l = 0; l < kWidth<T>; ++l) {
    problem_.energy.unload(l);
    if (next_ == problems_.size()) continue;
    const std::size_t k = next_++;
    problem_.load(l, *problems_[k]);
    if (!starts_.empty()) x_.load(l, *problems_[k], starts_[k]);
    set_lane(wanted, l, true);
    ready_.push_back(static_cast<int>(k));
  }
  if (!ready_.empty() && starts_.empty()) find_starts(wanted);
}

template <class T>
void StartQueue<T>::find_starts(const Mask<T>& wanted) {
  const energy::SceneModel<T>& energy = problem_.energy;
  // The static iterate: at rest in the final state, λ = λ(g), λ_0 = λ₀(g), c = 0.
  for (energy::Placement<T>& level : x_.p) {
    level.p = problem_.end;
    level.update();
  }
  for (std::vector<T>& lambda : x_.forces) energy.forces(x_.p[0], lambda.data());
  energy.forces(x_.p[0], x_.forces[0].data(), energy.barrier().start_spare());
  for (Vec3<T>& c : x_.controls) c.setConstant(T(0.0));
  for (std::vector<T>& y : x_.multipliers) std::ranges::fill(y, T(0.0));
  const Mask<T> open = energy.least_gap(x_.p[0]) > T(0.0) && energy.separated(x_.p[0]);
  warm_x_ = x_;
  const Mask<T> found = warm_.find(wanted, warm_x_);
  if (problem_.fixed_end()) {  // a forward simulation ends near the final state, not in it
    warm_x_.p.back() = x_.p.back();
    warm_x_.forces.back() = x_.forces.back();
  }
  x_.assign(found, warm_x_);
  for (std::size_t l = 0; l < ready_.size(); ++l)
    if (!lane(open, static_cast<int>(l))) ready_[l] = -1;
}

template class StartQueue<double>;
template class StartQueue<Lanes>;

}  // namespace rtg::reverse
