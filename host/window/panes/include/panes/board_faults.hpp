// Puts faults into a virtual board, and asks it what is in. Talks to the board in a thread of its own, so that the
// window never waits for it.
#pragma once

#include <condition_variable>
#include <cstdint>
#include <functional>
#include <mutex>
#include <string>
#include <thread>
#include <variant>
#include <vector>

#include <device/control_client.hpp>
#include <device/socket_address.hpp>

namespace inkwell::window {

class BoardFaults {
 public:
  struct Refusal {
    std::string sentence;
  };
  /// The board does not answer. What was asked for and not done yet is forgotten.
  struct Gone {
    std::string sentence;
  };
  using News = std::variant<device::Injections, device::PutInFault, Refusal, Gone>;

  explicit BoardFaults(device::SocketAddress control);
  ~BoardFaults();

  void inject(const protocol::InjectionRequest& request);
  void heal(const std::string& fault, const std::string& of);
  void heal_all();

  /// What has come since the last call, in its order; of answers in a row the newest.
  std::vector<News> take_news();
  /// Whether there is more than an answer that is like the last one.
  bool has_changed() const;

 private:
  using Request = std::function<void(device::ControlClient&)>;

  void run(const std::stop_token& stop);
  void ask(Request request);
  void carry_out(const Request& request, device::ControlClient& board);
  void tell(News news);

  device::SocketAddress control_;
  mutable std::mutex mutex_;
  std::condition_variable_any asked_;
  std::vector<Request> requests_;
  std::vector<News> news_;
  std::vector<device::PutInFault> seen_;  ///< of the last answer that was taken
  bool is_gone_ = false;                  ///< was told last
  std::jthread thread_;                   ///< last: it uses all of the above
};

}  // namespace inkwell::window
