#include "host/client/process/fork.hpp"

#include <fcntl.h>
#include <pthread.h>

#include <algorithm>
#include <utility>
#include <vector>

namespace inkwell::process {
namespace {

constinit HeldAtFork* first = nullptr;
constinit std::mutex descriptors_mutex;

/// Never destroyed, because destructors of static objects close descriptors.
std::vector<int>& descriptors() {
  static auto& all = *new std::vector<int>;
  return all;
}

}  // namespace

struct Forks {
  template <class Call>
  static void for_each(Call call) {
    for (const HeldAtFork* each = first; each != nullptr; each = each->next_) call(each->calls_, each->mutex_);
  }
  static void before() {
    for_each([](const auto& calls, void* mutex) { calls.lock(mutex); });
  }
  static void in_parent() {
    for_each([](const auto& calls, void* mutex) { calls.unlock(mutex); });
  }
  static void forget_descriptors() {
    const int nowhere = open("/dev/null", O_RDWR | O_CLOEXEC);
    for (const int descriptor : descriptors()) {
      if (nowhere >= 0)
        dup3(nowhere, descriptor, O_CLOEXEC);
      else
        close(descriptor);
    }
    if (nowhere >= 0) close(nowhere);
  }
  static void in_child() {
    forget_descriptors();
    descriptors().clear();
    for_each([](const auto& calls, void* mutex) { calls.make_new(mutex); });
  }
};

HeldAtFork::HeldAtFork(void* mutex, const Calls& calls)
    : mutex_(mutex), calls_(calls), next_(std::exchange(first, this)) {
  if (next_ == nullptr) pthread_atfork(&Forks::before, &Forks::in_parent, &Forks::in_child);
}

// ---- descriptors -------------------------------------------------------------------------------------------

namespace {

const HeldAtFork descriptors_at_fork(descriptors_mutex);

}  // namespace

OwnDescriptor::OwnDescriptor(int descriptor) : descriptor_(descriptor) {
  if (descriptor < 0) return;
  const std::lock_guard lock(descriptors_mutex);
  descriptors().push_back(descriptor);
}

OwnDescriptor::OwnDescriptor(OwnDescriptor&& other) noexcept : descriptor_(std::exchange(other.descriptor_, -1)) {}

OwnDescriptor& OwnDescriptor::operator=(OwnDescriptor&& other) noexcept {
  std::swap(descriptor_, other.descriptor_);
  return *this;
}

void OwnDescriptor::forget() {
  if (descriptor_ < 0) return;
  const std::lock_guard lock(descriptors_mutex);
  std::erase(descriptors(), std::exchange(descriptor_, -1));
}

void at_fork(void (*in_child)()) { pthread_atfork(nullptr, nullptr, in_child); }

}  // namespace inkwell::process
