#include "host/companion/window/scene/mouse_hand.hpp"

#include <chrono>
#include <utility>

#include "host/client/device/control_client.hpp"

namespace inkwell::window {

glm::vec3 within_reach(glm::vec3 probe_m, glm::vec3 wanted_m) {
  const float reach_m = hand_pull_maximum_N / static_cast<float>(hand_stiffness_N_per_m);
  const glm::vec3 away = wanted_m - probe_m;
  const float distance_m = glm::length(away);
  return distance_m <= reach_m ? wanted_m : probe_m + away * (reach_m / distance_m);
}

MouseHand::MouseHand(device::SocketAddress control)
    : control_(std::move(control)), thread_([this](const std::stop_token& stop) { run(stop); }) {}

MouseHand::~MouseHand() = default;  // std::jthread requests its thread to stop and joins it

void MouseHand::change(const Wish& wish) {
  wish_ = wish;
  changed_.notify_one();
}

void MouseHand::pull_to(glm::vec3 target_m) {
  const std::scoped_lock lock(mutex_);
  Wish wish = wish_;
  wish.docked = false;
  wish.target_m = target_m;
  change(wish);
}

void MouseHand::let_go() {
  const std::scoped_lock lock(mutex_);
  Wish wish = wish_;
  wish.target_m.reset();
  change(wish);
}

void MouseHand::put_into_inkwell() {
  const std::scoped_lock lock(mutex_);
  Wish wish = wish_;
  wish.target_m.reset();
  wish.docked = true;
  change(wish);
}

void MouseHand::reference_encoders() {
  const std::scoped_lock lock(mutex_);
  Wish wish = wish_;
  wish.target_m.reset();
  wish.docked = true;
  ++wish.references;
  change(wish);
}

void MouseHand::wait_outside(const std::stop_token& stop) {
  using namespace std::chrono_literals;
  std::unique_lock lock(mutex_);
  changed_.wait_for(lock, stop, 1s, [] { return false; });
}

void MouseHand::press_buttons(bool first, bool second) {
  const std::scoped_lock lock(mutex_);
  Wish wish = wish_;
  wish.first_button = first;
  wish.second_button = second;
  change(wish);
}

std::optional<glm::vec3> MouseHand::target_m() const {
  const std::scoped_lock lock(mutex_);
  return wish_.target_m;
}

bool MouseHand::is_docked() const {
  const std::scoped_lock lock(mutex_);
  return wish_.docked;
}

std::string MouseHand::error() const {
  const std::scoped_lock lock(mutex_);
  return error_;
}

void MouseHand::run(const std::stop_token& stop) {
  using namespace std::chrono_literals;
  std::optional<device::ControlClient> client;
  Wish done;
  while (!stop.stop_requested()) {
    Wish wish;
    {
      std::unique_lock lock(mutex_);
      changed_.wait(lock, stop, [&] { return wish_ != done; });
      wish = wish_;
    }
    if (stop.stop_requested()) return;
    try {
      if (!client) client.emplace(control_);
      if (wish.references != done.references && done.docked) {
        client->dock(false);
        wait_outside(stop);
        done.docked = false;
      }
      if (wish.docked != done.docked) client->dock(wish.docked);
      if (wish.target_m != done.target_m) {
        device::Hand hand{.holds = wish.target_m.has_value(),
                          .stiffness_N_per_m = hand_stiffness_N_per_m,
                          .damping_Ns_per_m = hand_damping_Ns_per_m};
        if (wish.target_m) hand.target_m = {wish.target_m->x, wish.target_m->y, wish.target_m->z};
        client->hand(hand);
      }
      if (wish.first_button != done.first_button || wish.second_button != done.second_button)
        client->buttons(wish.first_button, wish.second_button);
      done = wish;
      const std::scoped_lock lock(mutex_);
      error_.clear();
    } catch (const device::Error& failure) {
      client.reset();
      std::unique_lock lock(mutex_);
      error_ = failure.what();
      changed_.wait_for(lock, stop, 1s, [] { return false; });
    }
  }
}

}  // namespace inkwell::window
