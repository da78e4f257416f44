#include "core/search/generation.hpp"

#include <utility>

namespace rtg::search {

void Generation::repeat(const std::function<void(int)>& attempt) {
  constexpr int kMaxBarren = 8;
  for (int number = 0, barren = 0; barren < kMaxBarren && !data.full() && !cancelled(); ++number) {
    const long before = data.coverage().transitions();
    attempt(number);
    barren = data.coverage().transitions() > before ? 0 : barren + 1;
  }
}

void Generation::show(std::string phase, int layer, int depth) const {
  if (!seams.progress) return;
  const Coverage::Figures c = data.coverage().figures();
  seams.progress({std::move(phase), layer, depth, c.transitions, config.transitions,
                  c.contact_share, c.start_region_transitions});
}

}  // namespace rtg::search
