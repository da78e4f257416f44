#include "core/search/beam_search.hpp"

#include <utility>
#include <vector>

#include "core/search/simulators.hpp"
#include "nodes/config/config.hpp"
#include "train/bindings/arrays.hpp"
#include "train/bindings/bindings.hpp"
#include "train/bindings/engine.hpp"
#include "train/bindings/transition_arrays.hpp"

namespace rtg::bindings {
namespace {

/// A beam search with the simulators of its task.
class TaskSearch {
 public:
  TaskSearch(const config::Config& config, const StateArray& target, std::uint64_t seed,
             nb::object engine)
      : config_(config),
        engine_(std::move(engine)),
        seams_(search::in_process_seams(config_.task, config_.physics, config_.reverse,
                                        config_.search.generator, config_.run.workers,
                                        replays(config_, engine_))),
        search_(config_.task, config_.search, only_state(target, config_.task.scene.size()), seed,
                seams_.paces) {}
  TaskSearch(const TaskSearch&) = delete;  // the search refers to the task of this object
  TaskSearch& operator=(const TaskSearch&) = delete;

  void make_roots() {
    const nb::gil_scoped_release release;
    search_.make_roots(counted(seams_.replay, stats_, search::Stage::kGoals), stats_);
  }

  nb::tuple grow() {
    std::vector<search::Transition> found;
    {
      const nb::gil_scoped_release release;
      found = search_.grow(seams_.solve, seams_.replay, stats_);
    }
    return transition_arrays(found);
  }

  /// Returns poses [K, bodies, 3], action, parent and depth [K] of all nodes.
  nb::tuple nodes() const {
    const std::span<const search::Node> nodes = search_.nodes();
    const std::size_t count = nodes.size(), bodies = config_.task.scene.size();
    OwnedArray<double> poses(count * bodies * 3);
    OwnedArray<std::int64_t> action(count), parent(count), depth(count);
    for (std::size_t k = 0; k < count; ++k) {
      write_state(nodes[k].poses, poses.data.get() + k * bodies * 3);
      action.data[k] = nodes[k].action;
      parent.data[k] = nodes[k].parent;
      depth.data[k] = nodes[k].depth;
    }
    return nb::make_tuple(poses.release({count, bodies, 3}), action.release({count}),
                          parent.release({count}), depth.release({count}));
  }

  nb::ndarray<nb::numpy, std::int64_t> beam() const {
    OwnedArray<std::int64_t> out(search_.beam().size());
    std::ranges::copy(search_.beam(), out.data.get());
    return out.release({search_.beam().size()});
  }

  double start_distance() const { return search_.min_start_distance(); }

 private:
  config::Config config_;
  nb::object engine_;
  search::GenerationSeams seams_;
  search::SearchStats stats_;
  search::BeamSearch search_;
};

}  // namespace

void bind_search(nb::module_& module) {
  nb::class_<TaskSearch>(
      module, "BeamSearch",
      R"(A tree of reverse steps from goal states towards a start; see rtg.beam_search.

`target`: the start, [1, bodies, 3]. In units of the core.)")
      .def(nb::init<const config::Config&, const StateArray&, std::uint64_t, nb::object>(),
           nb::arg("config"), nb::arg("target"), nb::arg("seed"), nb::arg("engine") = nb::none())
      .def("make_roots", &TaskSearch::make_roots, "Makes the first beam: goal states, at rest.")
      .def("grow", &TaskSearch::grow,
           "Grows a layer. Returns poses, action, next poses, success and source of N transitions.")
      .def_prop_ro("nodes", &TaskSearch::nodes, nb::rv_policy::move,
                   "Poses [K, bodies, 3], action, parent and depth [K] of all nodes.")
      .def_prop_ro("beam", &TaskSearch::beam, nb::rv_policy::move,
                   "Indices of the nodes that the next layer starts from.")
      .def_prop_ro("start_distance", &TaskSearch::start_distance,
                   "Estimated pushes from the target to the nearest node of the beam.");
}

}  // namespace rtg::bindings
