#include "boards/stm32f405/peripherals/rtc.hpp"

#include <algorithm>
#include <chrono>
#include <utility>

#include "boards/stm32f405/peripherals/exti.hpp"
#include "boards/stm32f405/peripherals/rcc.hpp"

namespace inkwell::virtual_board {
namespace {

constexpr unsigned alarm_line = 17, wake_up_line = 22;
constexpr std::int64_t seconds_per_day = 86'400;
constexpr unsigned unlocked = 2;

/// A two-digit decimal number with a separate field for each digit.
struct Decimals {
  Field tens, units;
  constexpr std::uint32_t with(unsigned number) const { return tens.with(number / 10) | units.with(number % 10); }
  constexpr unsigned of(std::uint32_t word) const { return tens.of(word) * 10 + units.of(word); }
};
constexpr struct {
  Decimals second{rtc.tr.st, rtc.tr.su}, minute{rtc.tr.mnt, rtc.tr.mnu}, hour{rtc.tr.ht, rtc.tr.hu};
  Decimals day{rtc.dr.dt, rtc.dr.du}, month{rtc.dr.mt, rtc.dr.mu}, year{rtc.dr.yt, rtc.dr.yu};
} calendar;
constexpr auto year_2000 = std::chrono::sys_days(std::chrono::year(2000) / 1 / 1);

}  // namespace

void RealTimeClock::reset() {
  wakes_at_ = frozen_at_ = never;
  control_ = unlock_step_ = 0;
  status_ = 0;
  prescaler_ = rtc.prer.reset_value;
  reload_ = rtc.wutr.reset_value;
  written_time_ = rtc.tr.reset_value;
  written_date_ = rtc.dr.reset_value;
  alarms_ = {};
  backup_ = {};
  set_to_s_ = 0;
  set_at_ = synchronised_at_ = initialised_at_ = machine_.timeline.now();
  for (auto* planned : {&wake_up_, &second_})
    if (*planned != 0) events_.cancel(std::exchange(*planned, 0));
  update();
}

Clock RealTimeClock::clock() const { return Clock::of(rcc_.real_time_clock_Hz()); }

std::uint64_t RealTimeClock::cycles_per_second() const {
  return std::uint64_t{rtc.prer.prediv_a.of(prescaler_) + 1} * (rtc.prer.prediv_s.of(prescaler_) + 1);
}

std::uint64_t RealTimeClock::cycles() const {
  return rtc.isr.init.in(status_) ? 0 : clock().cycles_in(std::min(machine_.timeline.now(), frozen_at_) - set_at_);
}

std::uint32_t RealTimeClock::time_register() const {
  const std::int64_t now_s = set_to_s_ + static_cast<std::int64_t>(cycles() / cycles_per_second());
  const auto of_day = static_cast<unsigned>(now_s % seconds_per_day);
  unsigned hour = of_day / 3600;
  const bool twelve = rtc.cr.fmt.in(control_), afternoon = hour >= 12;
  if (twelve) hour = (hour + 11) % 12 + 1;
  return calendar.hour.with(hour) | calendar.minute.with(of_day / 60 % 60) | calendar.second.with(of_day % 60) |
         rtc.tr.pm.with(twelve && afternoon);
}

std::uint32_t RealTimeClock::date_register() const {
  const std::int64_t now_s = set_to_s_ + static_cast<std::int64_t>(cycles() / cycles_per_second());
  const auto day = year_2000 + std::chrono::days(now_s / seconds_per_day);
  const std::chrono::year_month_day date(day);
  return calendar.year.with(static_cast<unsigned>(static_cast<int>(date.year()) % 100)) |
         rtc.dr.wdu.with(std::chrono::weekday(day).iso_encoding()) |
         calendar.month.with(static_cast<unsigned>(date.month())) |
         calendar.day.with(static_cast<unsigned>(date.day()));
}

// The model derives the weekday from the date and ignores the weekday that firmware writes.
void RealTimeClock::set_calendar() {
  const auto date = std::chrono::year(2000 + static_cast<int>(calendar.year.of(written_date_))) /
                    static_cast<int>(calendar.month.of(written_date_)) /
                    static_cast<int>(calendar.day.of(written_date_));
  unsigned hour = calendar.hour.of(written_time_);
  if (rtc.cr.fmt.in(control_)) hour = hour % 12 + (rtc.tr.pm.in(written_time_) ? 12 : 0);
  set_to_s_ = date.ok() ? (std::chrono::sys_days(date) - year_2000).count() * seconds_per_day : 0;
  set_to_s_ += hour * 3600 + calendar.minute.of(written_time_) * 60 + calendar.second.of(written_time_);
  set_at_ = machine_.timeline.now();
}

std::uint32_t RealTimeClock::stored(std::uint32_t offset) const {
  if (rtc.bkpr.covers(offset)) return backup_[rtc.bkpr.index(offset)];
  switch (offset) {
    case rtc.cr: return control_;
    case rtc.prer: return prescaler_;
    case rtc.wutr: return reload_;
    case rtc.alrmar: return alarms_[0];
    case rtc.alrmbr: return alarms_[1];
    default: return 0;
  }
}

std::uint32_t RealTimeClock::read_word(std::uint32_t offset) {
  const bool initialising = rtc.isr.init.in(status_);
  const Ticks now = machine_.timeline.now(), two_cycles = clock().duration(2);
  switch (offset) {
    case rtc.tr: return initialising ? written_time_ : time_register();
    case rtc.dr: return initialising ? written_date_ : date_register();
    case rtc.ssr: {
      const std::uint64_t part = cycles() % cycles_per_second() / (rtc.prer.prediv_a.of(prescaler_) + 1);
      return rtc.prer.prediv_s.of(prescaler_) - static_cast<std::uint32_t>(part);
    }
    case rtc.isr: {
      std::uint32_t value = status_;
      if (!rtc.cr.alrae.in(control_)) value |= rtc.isr.alrawf.mask();
      if (!rtc.cr.alrbe.in(control_)) value |= rtc.isr.alrbwf.mask();
      if (!rtc.cr.wute.in(control_)) value |= rtc.isr.wutwf.mask();
      if (calendar.year.of(written_date_) != 0) value |= rtc.isr.inits.mask();
      if (!clock().runs()) return value;
      if (initialising && now >= initialised_at_ + two_cycles) value |= rtc.isr.initf.mask();
      if (!initialising && now >= synchronised_at_ + two_cycles) value |= rtc.isr.rsf.mask();
      return value;
    }
    default: break;
  }
  if (offset > rtc.ssr && !rtc.bkpr.covers(offset)) machine_.log.note("RTC", offset, false, 0);
  return stored(offset);
}

void RealTimeClock::write_status(std::uint32_t value) {
  const Ticks now = machine_.timeline.now();
  const bool was_initialising = rtc.isr.init.in(status_), initialises = rtc.isr.init.in(value);
  if (!rtc.isr.rsf.in(value)) synchronised_at_ = now;
  status_ &= value | ~bits_of(rtc.isr, Access::rc_w0);
  if (!was_initialising && initialises) {
    written_time_ = time_register();
    written_date_ = date_register();
    initialised_at_ = now;
  }
  status_ = (status_ & ~rtc.isr.init.mask()) | rtc.isr.init.with(initialises);
  if (was_initialising && !initialises) {
    set_calendar();
    synchronised_at_ = now;
    plan_second();
  }
}

void RealTimeClock::write_word(std::uint32_t offset, std::uint32_t value) {
  if (rtc.bkpr.covers(offset)) {
    backup_[rtc.bkpr.index(offset)] = value;
    return;
  }
  if (offset == rtc.wpr) {
    constexpr std::uint32_t keys[] = {0xCA, 0x53};
    unlock_step_ = unlock_step_ < unlocked && value == keys[unlock_step_] ? unlock_step_ + 1 : 0;
    return;
  }
  // The write protection does not cover the clearing of flags (RM0090, "RTC register write protection").
  if (unlock_step_ != unlocked && offset != rtc.isr) return;
  const bool initialising = rtc.isr.init.in(status_);
  switch (offset) {
    case rtc.tr:
      if (initialising) written_time_ = value & writable(rtc.tr);
      break;
    case rtc.dr:
      if (initialising) written_date_ = value & writable(rtc.dr);
      break;
    case rtc.prer:
      if (initialising) prescaler_ = value & writable(rtc.prer);
      break;
    case rtc.isr:
      write_status(unlock_step_ == unlocked ? value : (value & ~rtc.isr.init.mask()) | (status_ & rtc.isr.init.mask()));
      break;
    case rtc.cr:
      control_ = value & writable(rtc.cr);
      plan_wake_up();
      plan_second();
      break;
    case rtc.wutr:
      if (!rtc.cr.wute.in(control_)) reload_ = value & writable(rtc.wutr);
      break;
    case rtc.alrmar:
      if (!rtc.cr.alrae.in(control_)) alarms_[0] = value;
      break;
    case rtc.alrmbr:
      if (!rtc.cr.alrbe.in(control_)) alarms_[1] = value;
      break;
    default: machine_.log.note("RTC", offset, true, value);
  }
  update();
}

void RealTimeClock::plan_wake_up() {
  if (wake_up_ != 0) events_.cancel(std::exchange(wake_up_, 0));
  wakes_at_ = never;
  if (!rtc.cr.wute.in(control_) || !clock().runs()) return;
  // WUCKSEL selects the wake-up clock: RTCCLK divided by 16, 8, 4 or 2, or the 1 Hz clock. WUCKSEL 6 and 7 add 65536
  // counts.
  const std::uint32_t selected = rtc.cr.wcksel.of(control_);
  const std::uint64_t unit = selected < 4 ? 16u >> selected : cycles_per_second();
  const std::uint64_t counts = std::uint64_t{reload_} + 1 + (selected >= 6 ? 0x1'0000 : 0);
  wake_up_at(machine_.timeline.now() + clock().duration(unit * counts));
}

void RealTimeClock::wake_up_at(Ticks when) {
  wakes_at_ = when;
  wake_up_ = events_.at(when, [this] {
    wake_up_ = 0;
    status_ |= rtc.isr.wutf.mask();
    plan_wake_up();
    update();
  });
}

void RealTimeClock::freeze(bool frozen) {
  if (frozen == (frozen_at_ != never)) return;
  const Ticks now = machine_.timeline.now();
  if (frozen) {
    frozen_at_ = now;
    for (auto* planned : {&wake_up_, &second_})
      if (*planned != 0) events_.cancel(std::exchange(*planned, 0));
    return;
  }
  const Ticks stood = now - std::exchange(frozen_at_, never);
  set_at_ += stood;
  if (wakes_at_ != never) wake_up_at(wakes_at_ + stood);
  plan_second();
}

bool RealTimeClock::alarm_matches(std::uint32_t alarm) const {
  const std::uint32_t time = time_register(), date = date_register();
  const auto& map = rtc.alrmar;
  const auto same = [&](const Field& wanted, const Field& current) { return wanted.of(alarm) == current.of(time); };
  const bool weekday = map.du.of(alarm) == rtc.dr.wdu.of(date);
  const bool day = map.du.of(alarm) == rtc.dr.du.of(date) && map.dt.of(alarm) == rtc.dr.dt.of(date);
  return (map.msk1.in(alarm) || (same(map.st, rtc.tr.st) && same(map.su, rtc.tr.su))) &&
         (map.msk2.in(alarm) || (same(map.mnt, rtc.tr.mnt) && same(map.mnu, rtc.tr.mnu))) &&
         (map.msk3.in(alarm) || (same(map.pm, rtc.tr.pm) && same(map.ht, rtc.tr.ht) && same(map.hu, rtc.tr.hu))) &&
         (map.msk4.in(alarm) || (map.wdsel.in(alarm) ? weekday : day));
}

void RealTimeClock::plan_second() {
  if (second_ != 0) events_.cancel(std::exchange(second_, 0));
  const bool awaited = rtc.cr.alrae.in(control_) || rtc.cr.alrbe.in(control_);
  if (!awaited || !clock().runs() || rtc.isr.init.in(status_)) return;
  const std::uint64_t next = (cycles() / cycles_per_second() + 1) * cycles_per_second();
  second_ = events_.at(set_at_ + clock().duration(next), [this] {
    second_ = 0;
    second_over();
  });
}

void RealTimeClock::second_over() {
  if (rtc.cr.alrae.in(control_) && alarm_matches(alarms_[0])) status_ |= rtc.isr.alraf.mask();
  if (rtc.cr.alrbe.in(control_) && alarm_matches(alarms_[1])) status_ |= rtc.isr.alrbf.mask();
  plan_second();
  update();
}

// RTC interrupts pass through the EXTI edge detectors.
void RealTimeClock::update() {
  external_lines_.internal_line(alarm_line, (rtc.cr.alraie.in(control_) && rtc.isr.alraf.in(status_)) ||
                                                (rtc.cr.alrbie.in(control_) && rtc.isr.alrbf.in(status_)));
  external_lines_.internal_line(wake_up_line, rtc.cr.wutie.in(control_) && rtc.isr.wutf.in(status_));
}

}  // namespace inkwell::virtual_board
