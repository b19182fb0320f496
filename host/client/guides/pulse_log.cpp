#include "host/client/guides/pulse_log.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

#include "host/client/recording/writer.hpp"

namespace inkwell::guides {
namespace {

using protocol::Signal;

std::vector<Signal> pulse_signals() {
  std::vector<Signal> signals;
  for (const protocol::EachAxis<Signal> rows : std::initializer_list<protocol::EachAxis<Signal>>{
           Signal::current_reference_1_A, Signal::current_1_A, Signal::duty_1, Signal::joint_speed_1_rad_s})
    for (std::size_t i = 0; i < 3; ++i) signals.push_back(rows[i]);
  signals.push_back(Signal::supply_V);
  std::ranges::sort(signals);
  return signals;
}

}  // namespace

void PulseLog::add(const Observation& now, const recording::Recording& pulse, const std::string& mark) {
  if (file_.empty() || pulse.size() == 0 || !now.information || !now.parameters) return;
  constexpr std::size_t pause_samples = protocol::servo_rate_Hz / 100;
  if (all_.size() == 0)
    all_ = recording::Recording::without_samples(
        recording::describe(*now.information, *now.parameters, pulse_signals(), "", now.is_simulation));
  const std::size_t pause = all_.size() == 0 ? 0 : pause_samples;
  const std::int64_t begin = all_.size() == 0 ? pulse.periods.front() : all_.periods.back() + 1;
  for (std::size_t i = 0; i < pause + pulse.size(); ++i) all_.periods.push_back(begin + static_cast<std::int64_t>(i));
  for (std::size_t j = 0; j < all_.columns.size(); ++j) {
    auto& column = all_.columns[j];
    column.resize(column.size() + pause, std::nanf(""));
    const auto& recorded = pulse.information.signals;
    const auto found = std::ranges::find(recorded, all_.information.signals[j]);
    if (found == recorded.end())
      column.resize(all_.size(), std::nanf(""));
    else
      std::ranges::copy(pulse.columns[static_cast<std::size_t>(found - recorded.begin())], std::back_inserter(column));
  }
  all_.marks.push_back(
      {begin + static_cast<std::int64_t>(pause), mark, device::EventKind::mark, device::clock_utc_now()});
  recording::save(all_, file_);
}

}  // namespace inkwell::guides
