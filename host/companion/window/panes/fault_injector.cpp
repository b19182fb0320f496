#include "host/companion/window/panes/fault_injector.hpp"

#include <algorithm>
#include <chrono>
#include <optional>
#include <utility>

namespace inkwell::window {

namespace {

using namespace std::chrono_literals;

constexpr auto asked_every = 200ms;
constexpr auto answer_limit = 2s;  // for a board that a debugger has stopped; also delays the close of the window

}  // namespace

FaultInjector::FaultInjector(device::SocketAddress control)
    : control_(std::move(control)), thread_([this](const std::stop_token& stop) { run(stop); }) {}

FaultInjector::~FaultInjector() = default;  // std::jthread requests its thread to stop and joins it

void FaultInjector::inject(const protocol::InjectionRequest& request) {
  queue_request([this, request](device::ControlClient& board) { publish(board.inject(request)); });
}

void FaultInjector::heal(const std::string& fault, const std::string& of) {
  queue_request([fault, of](device::ControlClient& board) { board.heal(fault, of); });
}

void FaultInjector::heal_all() {
  queue_request([](device::ControlClient& board) { board.heal_all(); });
}

void FaultInjector::queue_request(Request request) {
  const std::scoped_lock lock(mutex_);
  requests_.push_back(std::move(request));
  asked_.notify_one();
}

void FaultInjector::publish(News news) {
  const std::scoped_lock lock(mutex_);
  const bool is_answer = std::holds_alternative<device::Injections>(news);
  const bool is_gone = std::holds_alternative<Gone>(news);
  if (is_gone && std::exchange(is_gone_, true)) return;
  if (!is_gone) is_gone_ = false;
  if (is_answer && !news_.empty() && std::holds_alternative<device::Injections>(news_.back())) news_.pop_back();
  news_.push_back(std::move(news));
}

std::vector<FaultInjector::News> FaultInjector::take_news() {
  const std::scoped_lock lock(mutex_);
  for (const News& each : news_)
    if (const auto* answer = std::get_if<device::Injections>(&each)) seen_ = answer->faults;
  return std::exchange(news_, {});
}

bool FaultInjector::has_changed() const {
  const std::scoped_lock lock(mutex_);
  return std::ranges::any_of(news_, [this](const News& each) {
    const auto* answer = std::get_if<device::Injections>(&each);
    return answer == nullptr || answer->faults != seen_;
  });
}

void FaultInjector::carry_out(const Request& request, device::ControlClient& board) {
  try {
    request(board);
  } catch (const device::CommandRefused& refused) {
    publish(Refusal{refused.what()});
  }
}

void FaultInjector::run(const std::stop_token& stop) {
  std::optional<device::ControlClient> board;
  while (!stop.stop_requested()) {
    std::vector<Request> requests;
    {
      std::unique_lock lock(mutex_);
      asked_.wait_for(lock, stop, asked_every, [this] { return !requests_.empty(); });
      requests = std::exchange(requests_, {});
    }
    if (stop.stop_requested()) return;
    try {
      if (!board) {
        board.emplace(control_);
        board->wait_at_most(answer_limit);
      }
      for (const Request& request : requests) carry_out(request, *board);
      publish(board->injections());
    } catch (const device::Error& failure) {
      board.reset();
      publish(Gone{failure.what()});
    }
  }
}

}  // namespace inkwell::window
