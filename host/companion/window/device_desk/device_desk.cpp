#include "host/companion/window/device_desk/device_desk.hpp"

#include <chrono>
#include <utility>

#include "host/companion/window/device_desk/arm_choice.hpp"

namespace inkwell::window {

namespace {
constexpr std::size_t scope_frames_maximum = 20'000;  // about ten seconds without a drawn frame
}

DeviceDesk::DeviceDesk(std::function<std::vector<device::Endpoint>()> list_devices, std::string serial_number,
                       PoseReceiver receive_pose)
    : list_devices_(std::move(list_devices)),
      receive_pose_(std::move(receive_pose)),
      wanted_(std::move(serial_number)) {
  open_session();
  searcher_ = std::jthread([this](const std::stop_token& stop) {
    using namespace std::chrono_literals;
    for (int tick = 0; !stop.stop_requested(); ++tick) {
      if (is_searching_ && tick % 10 == 0) find_endpoints();
      std::this_thread::sleep_for(100ms);
    }
  });
}

DeviceDesk::~DeviceDesk() {
  searcher_.request_stop();
  session_.reset();
}

std::vector<device::Endpoint> DeviceDesk::find_endpoints() {
  std::vector<device::Endpoint> found;
  std::string error;
  try {
    found = list_devices_();
  } catch (const device::Error& failure) {
    error = failure.what();
  }
  const std::scoped_lock lock(mutex_);
  listed_ = found;
  list_error_ = error;
  return found;
}

void DeviceDesk::open_session() {
  session_ = std::make_unique<device::Session>([this, choice = ArmChoice(wanted_)]() mutable {
    const std::vector<device::Endpoint> found = find_endpoints();
    must_choose_ = false;
    try {
      return choice.pick(found);
    } catch (const device::NoDevice&) {
      must_choose_ = true;
      throw;
    }
  });
  session_->on_scope([this](const device::ScopeSamples& samples) {
    const std::scoped_lock lock(mutex_);
    if (scope_.size() < scope_frames_maximum) scope_.push_back(samples);
  });
  if (receive_pose_) session_->on_pose(receive_pose_);
  if (!signals_.empty()) session_->select_signals(signals_);
}

const DeviceView& DeviceDesk::refresh() {
  view_.reconnection = session_->reconnection();  // read first, because all other data must be at least as new
  events_.add(session_->take_events());
  view_.status = session_->status();
  view_.pose = view_.connected() ? session_->newest_pose() : std::nullopt;
  view_.refusal = session_->refusal();
  const std::uint64_t revision = session_->parameters_revision();
  if (revision != view_.parameters_revision || !view_.connected()) {
    view_.parameters_revision = revision;
    view_.parameters = view_.connected() ? session_->parameters() : std::nullopt;
  } else if (!view_.parameters) {
    view_.parameters = session_->parameters();
  }
  view_.must_choose = !view_.connected() && must_choose_;
  const std::scoped_lock lock(mutex_);
  view_.listed = listed_;
  view_.list_error = list_error_;
  return view_;
}

void DeviceDesk::follow_choice() {
  wanted_ = *std::exchange(choice_, std::nullopt);
  events_.add(session_->take_events());
  if (view_.connected())
    events_.add(device::event_now(device::EventKind::connection, "Disconnected, because the user chose another device.",
                                  std::nullopt));
  session_.reset();  // the old session releases the device before the new session opens it
  view_ = DeviceView{};
  {
    const std::scoped_lock lock(mutex_);
    scope_.clear();
  }
  open_session();
}

void DeviceDesk::mark(const std::string& text) {
  events_.add(device::event_now(device::EventKind::mark, text,
                                view_.pose ? std::optional(view_.pose->time_periods) : std::nullopt));
}

void DeviceDesk::select_signals(std::vector<protocol::Signal> signals) {
  if (signals == signals_) return;
  signals_ = std::move(signals);
  session_->select_signals(signals_);
}

std::vector<device::ScopeSamples> DeviceDesk::take_scope() {
  const std::scoped_lock lock(mutex_);
  return std::exchange(scope_, {});
}

}  // namespace inkwell::window
