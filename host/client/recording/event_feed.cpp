#include "host/client/recording/event_feed.hpp"

#include <fmt/format.h>

namespace inkwell::recording {

void EventFeed::take(const device::Pose& pose) {
  if (before_ && pose.sequence > before_->sequence + 1) {
    const auto lost = static_cast<std::uint64_t>(pose.sequence - before_->sequence - 1);
    lost_poses_ += lost;
    if (const auto event = device::event_of_lost_poses(lost, pose.time_periods)) recorder_.note(*event);
  }
  for (const auto& event : device::events_between(before_, pose, std::nullopt)) recorder_.note(event);
  for (const auto& event : hand_.take(pose)) recorder_.note(event);
  before_ = pose;
  if (const std::uint64_t lost = recorder_.status().lost; lost > noted_samples_) {
    recorder_.note(device::event_now(device::EventKind::loss,
                                     fmt::format("{} samples were lost.", lost - noted_samples_), pose.time_periods));
    noted_samples_ = lost;
  }
}

}  // namespace inkwell::recording
