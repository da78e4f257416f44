#pragma once

#include <rtg_msgs/node_status_t.hpp>
#include <rtg_msgs/replay_job_t.hpp>
#include <rtg_msgs/replay_result_t.hpp>
#include <rtg_msgs/reverse_job_t.hpp>
#include <rtg_msgs/reverse_result_t.hpp>
#include <rtg_msgs/search_progress_t.hpp>
#include <rtg_msgs/stream_ack_t.hpp>
#include <rtg_msgs/stream_tail_t.hpp>
#include <rtg_msgs/transition_batch_t.hpp>
#include <rtg_msgs/worker_beat_t.hpp>

/// The fields of each message in the order of its .lcm file, for visitors that check bytes before
/// decoding and values after: v.scalar(x), v.count(n), v.array(vector, n), v.text(string),
/// v.texts(vector of strings, n).
namespace rtg::bus {

template <class V>
void fields(V& v, rtg_msgs::header_t& m) {
  v.scalar(m.protocol), v.scalar(m.run), v.scalar(m.sender);
}

template <class V>
void fields(V& v, rtg_msgs::worker_beat_t& m) {
  fields(v, m.header);
  v.scalar(m.incarnation), v.scalar(m.worker), v.scalar(m.config), v.scalar(m.capacity);
  v.count(m.n_held), v.array(m.held, m.n_held);
}

template <class V>
void fields(V& v, rtg_msgs::reverse_job_t& m) {
  fields(v, m.header);
  v.scalar(m.job_id), v.scalar(m.to), v.scalar(m.attempt);
  v.count(m.n), v.count(m.n_poses);
  v.array(m.end, m.n_poses), v.array(m.action, m.n);
}

template <class V>
void fields(V& v, rtg_msgs::reverse_result_t& m) {
  fields(v, m.header);
  v.scalar(m.job_id), v.scalar(m.incarnation);
  v.count(m.n), v.count(m.n_poses);
  v.array(m.status, m.n), v.array(m.iterations, m.n), v.array(m.cpu_s, m.n);
  v.array(m.starts, m.n), v.array(m.start, m.n_poses);
}

template <class V>
void fields(V& v, rtg_msgs::replay_job_t& m) {
  fields(v, m.header);
  v.scalar(m.job_id), v.scalar(m.to), v.scalar(m.attempt);
  v.count(m.n), v.count(m.n_poses);
  v.array(m.start, m.n_poses), v.array(m.action, m.n);
}

template <class V>
void fields(V& v, rtg_msgs::replay_result_t& m) {
  fields(v, m.header);
  v.scalar(m.job_id), v.scalar(m.incarnation);
  v.count(m.n), v.count(m.n_poses);
  v.array(m.ok, m.n), v.array(m.cpu_s, m.n), v.array(m.end, m.n_poses);
}

template <class V>
void fields(V& v, rtg_msgs::transition_batch_t& m) {
  fields(v, m.header);
  v.scalar(m.stream), v.scalar(m.first);
  v.count(m.n), v.count(m.n_poses);
  v.array(m.poses, m.n_poses), v.array(m.next_poses, m.n_poses);
  v.array(m.action, m.n), v.array(m.success, m.n), v.array(m.source, m.n);
}

template <class V>
void fields(V& v, rtg_msgs::stream_tail_t& m) {
  fields(v, m.header);
  v.scalar(m.stream), v.scalar(m.count), v.scalar(m.sealed);
}

template <class V>
void fields(V& v, rtg_msgs::stream_ack_t& m) {
  fields(v, m.header);
  v.scalar(m.stream), v.scalar(m.consumer), v.scalar(m.cursor), v.scalar(m.credit);
  v.count(m.n), v.array(m.first, m.n), v.array(m.last, m.n);
}

template <class V>
void fields(V& v, rtg_msgs::search_progress_t& m) {
  fields(v, m.header);
  v.scalar(m.config), v.text(m.phase), v.scalar(m.layer), v.scalar(m.depth);
  v.scalar(m.transitions), v.scalar(m.target), v.scalar(m.contact_share), v.scalar(m.start_region);
  v.scalar(m.workers), v.scalar(m.jobs_open), v.scalar(m.consumers), v.scalar(m.slowest_cursor);
  v.scalar(m.leaving);
}

template <class V>
void fields(V& v, rtg_msgs::node_status_t& m) {
  fields(v, m.header);
  v.text(m.node), v.scalar(m.number), v.text(m.state), v.scalar(m.done), v.scalar(m.cpu_s);
  v.count(m.n), v.texts(m.counter_name, m.n), v.array(m.counter_value, m.n);
}

}  // namespace rtg::bus
