#include "host/client/device/sleep_inhibitor.hpp"

#include <fcntl.h>
#include <sched.h>
#include <signal.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <optional>
#include <system_error>

#include "host/client/local/descriptor.hpp"
#include "host/client/local/interruption.hpp"

#include "host/client/device/spawn_actions.hpp"

namespace inkwell::device {
namespace {

/// systemd-inhibit prevents sleep while `cat` runs. `cat` exits when its input pipe is closed.
constexpr std::array<const char*, 6> inhibitor_command{"systemd-inhibit", "--what=sleep:idle",
                                                       "--who=Inkwell",   "--why=The force of the haptic arm is on",
                                                       "--mode=block",    "cat"};

class SpawnAttributes {
 public:
  /// Runs the child in a separate session. Ctrl-C then does not stop the child, and the child cannot ask for a password
  /// on the terminal. Restores the default signal handling for the child.
  SpawnAttributes() {
    posix_spawnattr_init(&attributes_);
    sigset_t none, all;
    sigemptyset(&none);
    sigfillset(&all);
    posix_spawnattr_setsigmask(&attributes_, &none);
    posix_spawnattr_setsigdefault(&attributes_, &all);
    posix_spawnattr_setflags(&attributes_, POSIX_SPAWN_SETSID | POSIX_SPAWN_SETSIGMASK | POSIX_SPAWN_SETSIGDEF);
  }
  ~SpawnAttributes() { posix_spawnattr_destroy(&attributes_); }
  SpawnAttributes(const SpawnAttributes&) = delete;
  SpawnAttributes& operator=(const SpawnAttributes&) = delete;
  const posix_spawnattr_t* get() const { return &attributes_; }

 private:
  posix_spawnattr_t attributes_{};
};

/// Returns the process number of the child, or 0 if the child cannot be started.
pid_t spawn(int input) {
  SpawnActions actions;
  posix_spawn_file_actions_adddup2(actions.get(), input, STDIN_FILENO);
  posix_spawn_file_actions_addopen(actions.get(), STDOUT_FILENO, "/dev/null", O_WRONLY, 0);
  posix_spawn_file_actions_adddup2(actions.get(), STDOUT_FILENO, STDERR_FILENO);
  posix_spawn_file_actions_addclosefrom_np(actions.get(), STDERR_FILENO + 1);
  posix_spawn_file_actions_addchdir_np(actions.get(), "/");
  const SpawnAttributes attributes;
  std::array<char*, inhibitor_command.size() + 1> arguments{};
  for (std::size_t i = 0; i < inhibitor_command.size(); ++i)
    arguments[i] = const_cast<char*>(inhibitor_command[i]);  // exec() requires non-const pointers
  pid_t child = 0;
  const int code =
      posix_spawnp(&child, inhibitor_command[0], actions.get(), attributes.get(), arguments.data(), environ);
  return code == 0 ? child : 0;
}

class RunningInhibitor {
 public:
  RunningInhibitor() {
    int ends[2];
    if (pipe2(ends, O_CLOEXEC) != 0) return;
    const local::Descriptor from_here(ends[0]);
    to_child_ = local::Descriptor(ends[1]);
    own_ = process::OwnDescriptor(ends[1]);
    child_ = spawn(from_here.number());
  }
  ~RunningInhibitor() {
    // If the program has already reaped the child, its process number may belong to another process.
    if (child_ != 0 && waitpid(child_, nullptr, WNOHANG) == 0) {
      kill(child_, SIGKILL);  // the child may still wait for logind
      local::repeat_interrupted([&] { return waitpid(child_, nullptr, 0); });
    }
  }
  RunningInhibitor(const RunningInhibitor&) = delete;
  RunningInhibitor& operator=(const RunningInhibitor&) = delete;

 private:
  local::Descriptor to_child_;
  process::OwnDescriptor own_;  ///< closes the pipe in forked children
  pid_t child_ = 0;
};

/// Resets the priority and blocks signals, because a new thread inherits both from its creator.
void become_ordinary_thread() {
  sigset_t all;
  sigfillset(&all);
  pthread_sigmask(SIG_SETMASK, &all, nullptr);  // signals are handled by other threads
  const int policy = sched_getscheduler(0) & ~SCHED_RESET_ON_FORK;
  const sched_param ordinary{};
  if (policy == SCHED_FIFO || policy == SCHED_RR) sched_setscheduler(0, SCHED_OTHER, &ordinary);
  const auto thread = static_cast<id_t>(gettid());
  if (getpriority(PRIO_PROCESS, thread) < 0) setpriority(PRIO_PROCESS, thread, 0);
}

}  // namespace

SleepInhibitor::~SleepInhibitor() {
  if (!origin_.is_here()) {
    static_cast<void>(thread_.release());  // the thread does not run in a forked child
    return;
  }
  if (!thread_) return;
  request(Request::end);
  thread_->join();
}

void SleepInhibitor::prepare() {
  if (!origin_.is_here()) return;
  std::call_once(is_prepared_, [this] {
    try {
      thread_ = std::make_unique<std::thread>([this] { serve(); });
    } catch (const std::system_error&) {  // without the thread, sleep is not prevented
    }
  });
}

void SleepInhibitor::request(Request request) {
  if (request_.exchange(request) != request) request_.notify_one();
}

void SleepInhibitor::serve() {
  become_ordinary_thread();
  std::optional<RunningInhibitor> running;
  Request done = Request::release;
  while (done != Request::end) {
    request_.wait(done);
    done = request_;
    if (done == Request::hold)
      running.emplace();
    else
      running.reset();
  }
}

}  // namespace inkwell::device
