// Injects faults into a virtual board and polls the active faults. A separate thread communicates with the board, so
// that the window never blocks.
#pragma once

#include <condition_variable>
#include <cstdint>
#include <functional>
#include <mutex>
#include <string>
#include <thread>
#include <variant>
#include <vector>

#include "host/client/device/control_client.hpp"
#include "host/client/device/socket_address.hpp"

namespace inkwell::window {

class FaultInjector {
 public:
  struct Refusal {
    std::string sentence;
  };
  /// The board does not answer. Pending requests are discarded.
  struct Gone {
    std::string sentence;
  };
  using News = std::variant<device::Injections, device::Injection, Refusal, Gone>;

  explicit FaultInjector(device::SocketAddress control);
  ~FaultInjector();

  void inject(const protocol::InjectionRequest& request);
  void heal(const std::string& fault, const std::string& of);
  void heal_all();

  /// Returns answers and errors since the last call. Omits outdated answers.
  std::vector<News> take_news();
  /// Returns true after an error or an answer with different faults.
  bool has_changed() const;

 private:
  using Request = std::function<void(device::ControlClient&)>;

  void run(const std::stop_token& stop);
  void queue_request(Request request);
  void carry_out(const Request& request, device::ControlClient& board);
  void publish(News news);

  device::SocketAddress control_;
  mutable std::mutex mutex_;
  std::condition_variable_any asked_;
  std::vector<Request> requests_;
  std::vector<News> news_;
  std::vector<device::Injection> seen_;  ///< faults of the last returned answer
  bool is_gone_ = false;                 ///< last reported state
  std::jthread thread_;                  ///< last member, because the thread uses all members above
};

}  // namespace inkwell::window
