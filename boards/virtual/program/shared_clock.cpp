#include "boards/virtual/program/shared_clock.hpp"

#include <fcntl.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <stdexcept>
#include <string>

#include "host/client/local/interruption.hpp"

namespace inkwell::virtual_board {
namespace {

/// A joining board locks the byte after the last slot.
constexpr off_t joining = SharedClock::boards_maximum;

struct flock lock_of(off_t byte, short type) {
  struct flock lock {};
  lock.l_type = type;
  lock.l_whence = SEEK_SET;
  lock.l_start = byte;
  lock.l_len = 1;
  return lock;
}

bool set_lock(int file, off_t byte, short type, bool waits = false) {
  struct flock lock = lock_of(byte, type);
  return local::repeat_interrupted([&] { return ::fcntl(file, waits ? F_OFD_SETLKW : F_OFD_SETLK, &lock); }) == 0;
}

std::runtime_error failure(const std::filesystem::path& file, const std::string& what) {
  return std::runtime_error("The clock " + file.string() + " cannot be shared: " + what);
}

}  // namespace

SharedClock::SharedClock(const std::filesystem::path& file)
    : file_(::open(file.c_str(), O_RDWR | O_CREAT | O_CLOEXEC | O_NOFOLLOW, 0600)) {
  if (file_ < 0) throw failure(file, std::string(std::strerror(errno)) + ". Use a file that you may write.");
  try {
    struct stat about {};
    if (::fstat(file_, &about) != 0 || (about.st_size != 0 && about.st_size != sizeof(Slots)))
      throw failure(file, "the file is not a clock. Use a new file name.");
    if (::ftruncate(file_, sizeof(Slots)) != 0) throw failure(file, std::strerror(errno));
    void* const memory = ::mmap(nullptr, sizeof(Slots), PROT_READ | PROT_WRITE, MAP_SHARED, file_, 0);
    if (memory == MAP_FAILED) throw failure(file, std::strerror(errno));
    slots_ = static_cast<Slots*>(memory);
    set_lock(file_, joining, F_WRLCK, true);
    join();
    set_lock(file_, joining, F_UNLCK);
    if (mine_ == boards_maximum) throw failure(file, "16 boards use the clock. Exit one board, or use another file.");
  } catch (...) {
    if (slots_ != nullptr) ::munmap(slots_, sizeof(Slots));
    ::close(file_);
    throw;
  }
}

SharedClock::~SharedClock() {
  (*slots_)[mine_] = 0;
  ::munmap(slots_, sizeof(Slots));
  ::close(file_);  // also releases the lock on its slot
}

void SharedClock::join() {
  for (std::size_t slot = 0; slot < boards_maximum; ++slot)
    if (!is_taken(slot)) (*slots_)[slot] = 0;  // slot of a killed board
  joined_at_ = farthest();
  for (mine_ = 0; mine_ < boards_maximum; ++mine_)
    if (set_lock(file_, static_cast<off_t>(mine_), F_WRLCK)) break;
  if (mine_ < boards_maximum) (*slots_)[mine_] = joined_at_;
}

bool SharedClock::is_taken(std::size_t slot) const {
  struct flock lock = lock_of(static_cast<off_t>(slot), F_WRLCK);
  return ::fcntl(file_, F_OFD_GETLK, &lock) == 0 && lock.l_type != F_UNLCK;
}

std::uint64_t SharedClock::farthest() const {
  std::uint64_t farthest = 1;
  for (const Slot& slot : *slots_) farthest = std::max(farthest, slot.load());
  return farthest;
}

void SharedClock::note(std::uint64_t milliseconds) { (*slots_)[mine_] = joined_at_ + milliseconds; }

bool SharedClock::lets_pass() {
  const std::uint64_t mine = (*slots_)[mine_];
  for (std::size_t slot = 0; slot < boards_maximum; ++slot) {
    std::uint64_t other = (*slots_)[slot];
    if (other == 0 || other >= mine) continue;
    if (is_taken(slot)) return false;
    (*slots_)[slot].compare_exchange_strong(other, 0);  // unless another board has just joined in this slot
  }
  return true;
}

}  // namespace inkwell::virtual_board
