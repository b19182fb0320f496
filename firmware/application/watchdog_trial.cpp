#include "firmware/application/watchdog_trial.hpp"

#include "firmware/drivers/clocks.hpp"
#include "firmware/drivers/cycle_counter.hpp"
#include "firmware/drivers/kept_over_reset.hpp"

#include "firmware/application/parts.hpp"

namespace inkwell::application {
namespace {

enum class Outcome : std::uint32_t { open, expired, none };

struct Course {
  std::uint32_t reset_flags;  ///< reset flags of the power-on that started the trial
  Outcome outcome;
};

[[gnu::section(".noinit")]] drivers::KeptOverReset<Course> kept_course;
/// Time since the start of the watchdog. A single variable stays valid if the reset occurs between two instructions.
[[gnu::section(".noinit")]] volatile std::uint32_t waited_us;

/// The timeout is 20 ms at the nominal oscillator frequency of 32 kHz, which may be 17 to 47 kHz. The internal
/// oscillator measures this timeout with an error of at most 4 % from -10 to 85 C (data sheet).
constexpr std::uint32_t earliest_us = 13'000, latest_us = 40'000, patience_us = 100'000;

/// Returns only if the watchdog does not expire.
void wait_for_reset() {
  constexpr std::uint32_t cycles_per_us = drivers::internal_oscillator_Hz / 1'000'000;
  static_cast<void>(watchdog.start());  // main() repeats the start and checks the result
  const std::uint32_t from_cycles = drivers::CycleCounter::now();
  std::uint32_t waited_now_us;
  do waited_us = waited_now_us = (drivers::CycleCounter::now() - from_cycles) / cycles_per_us;
  while (waited_now_us < patience_us);
}

}  // namespace

WatchdogTrial try_watchdog(const drivers::ResetCause& cause) {
  // While BOOT0 is high, a watchdog reset starts the boot loader instead of the firmware.
  if (cause.power_on() && !started_by_boot_loader) {
    kept_course.store({cause.flags, Outcome::open});
    wait_for_reset();
    kept_course.store({cause.flags, Outcome::none});
  }
  auto course = kept_course.load_and_erase();
  if (!course) return {cause, true, 0.0f};
  WatchdogTrial trial{cause, course->outcome != Outcome::none, 0.0f};
  if (course->outcome == Outcome::open && cause.watchdog()) {
    trial.cause = {course->reset_flags};
    course->outcome = Outcome::expired;
  }
  // The trial is undecided if another cause has reset the chip. The next watchdog reset does not belong to the trial,
  // so nothing is stored.
  if (course->outcome == Outcome::open) return trial;
  if (course->outcome == Outcome::expired) {
    trial.is_passed = waited_us > earliest_us && waited_us < latest_us;
    trial.expired_after_ms = 1e-3f * static_cast<float>(waited_us);
  }
  kept_course.store(*course);
  return trial;
}

}  // namespace inkwell::application
