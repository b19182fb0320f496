// Real-time clock (RM0090, "Real-time clock"): calendar, wake-up timer, alarms A and B (resolution 1 s), backup
// registers, write protection. Not modeled: tamper detection, time stamps, calibration.
#pragma once

#include <array>

#include "boards/stm32f405/memory/register_block.hpp"
#include "boards/stm32f405/peripherals/lines.hpp"
#include "boards/stm32f405/peripherals/rcc.hpp"

namespace inkwell::virtual_board {

/// Fields of the registers ALRMAR and ALRMBR.
struct RtcAlarm : Register {
  Field su{"SU", 0, 4}, st{"ST", 4, 3}, msk1{"MSK1", 7}, mnu{"MNU", 8, 4}, mnt{"MNT", 12, 3}, msk2{"MSK2", 15},
      hu{"HU", 16, 4}, ht{"HT", 20, 2}, pm{"PM", 22}, msk3{"MSK3", 23}, du{"DU", 24, 4}, dt{"DT", 28, 2},
      wdsel{"WDSEL", 30}, msk4{"MSK4", 31};
};

struct RtcRegisters {
  struct : Register {
    Field su{"SU", 0, 4}, st{"ST", 4, 3}, mnu{"MNU", 8, 4}, mnt{"MNT", 12, 3}, hu{"HU", 16, 4}, ht{"HT", 20, 2},
        pm{"PM", 22};
  } tr{{"TR", 0x00}};
  struct : Register {
    Field du{"DU", 0, 4}, dt{"DT", 4, 2}, mu{"MU", 8, 4}, mt{"MT", 12}, wdu{"WDU", 13, 3}, yu{"YU", 16, 4},
        yt{"YT", 20, 4};
  } dr{{"DR", 0x04, 0x2101}};
  struct : Register {
    Field wcksel{"WCKSEL", 0, 3}, tsedge{"TSEDGE", 3}, refckon{"REFCKON", 4}, fmt{"FMT", 6}, dce{"DCE", 7},
        alrae{"ALRAE", 8}, alrbe{"ALRBE", 9}, wute{"WUTE", 10}, tse{"TSE", 11}, alraie{"ALRAIE", 12},
        alrbie{"ALRBIE", 13}, wutie{"WUTIE", 14}, tsie{"TSIE", 15}, add1h{"ADD1H", 16, 1, Access::w},
        sub1h{"SUB1H", 17, 1, Access::w}, bkp{"BKP", 18}, pol{"POL", 20}, osel{"OSEL", 21, 2}, coe{"COE", 23};
  } cr{{"CR", 0x08}};
  struct : Register {
    Field alrawf{"ALRAWF", 0, 1, Access::r}, alrbwf{"ALRBWF", 1, 1, Access::r}, wutwf{"WUTWF", 2, 1, Access::r},
        shpf{"SHPF", 3, 1, Access::r}, inits{"INITS", 4, 1, Access::r}, rsf{"RSF", 5, 1, Access::rc_w0},
        initf{"INITF", 6, 1, Access::r}, init{"INIT", 7}, alraf{"ALRAF", 8, 1, Access::rc_w0},
        alrbf{"ALRBF", 9, 1, Access::rc_w0}, wutf{"WUTF", 10, 1, Access::rc_w0}, tsf{"TSF", 11, 1, Access::rc_w0},
        tsovf{"TSOVF", 12, 1, Access::rc_w0}, tamp1f{"TAMP1F", 13, 1, Access::rc_w0},
        tamp2f{"TAMP2F", 14, 1, Access::rc_w0}, recalpf{"RECALPF", 16, 1, Access::r};
  } isr{{"ISR", 0x0C, 0x0007}};
  struct : Register {
    Field prediv_s{"PREDIV_S", 0, 15}, prediv_a{"PREDIV_A", 16, 7};
  } prer{{"PRER", 0x10, 0x007F'00FF}};
  struct : Register {
    Field wut{"WUT", 0, 16};
  } wutr{{"WUTR", 0x14, 0xFFFF}};
  RtcAlarm alrmar{{"ALRMAR", 0x1C}}, alrmbr{{"ALRMBR", 0x20}};
  struct : Register {
    Field key{"KEY", 0, 8, Access::w};
  } wpr{{"WPR", 0x24}};
  struct : Register {
    Field ss{"SS", 0, 16, Access::r};
  } ssr{{"SSR", 0x28}};
  struct : Register {
    Field bkp{"BKP", 0, 32};
  } bkpr{{"BKP#R", 0x50, 0, {20, 4, 0}}};
};
inline constexpr RtcRegisters rtc;

class RealTimeClock final : public RegisterBlock, public Freezable {
 public:
  RealTimeClock(Machine& machine, Scheduler& events, const Rcc& rcc, ExternalLines& external_lines)
      : machine_(machine), events_(events), rcc_(rcc), external_lines_(external_lines) {
    constexpr unsigned stop_bit = 10;  // DBG_RTC_STOP
    machine.debug_halt.add(*this, DebugHalt::apb1, stop_bit);
  }
  void reset() override;
  void freeze(bool frozen) override;

 protected:
  std::uint32_t read_word(std::uint32_t offset) override;
  void write_word(std::uint32_t offset, std::uint32_t value) override;
  std::uint32_t stored(std::uint32_t offset) const override;
  std::span<const MapEntry> registers() const override { return shown<rtc>(); }

 private:
  /// Returns RTCCLK. RTCCLK is stopped while RTCEN is clear or the oscillator is not ready.
  Clock clock() const;
  std::uint64_t cycles_per_second() const;
  /// Cycles of RTCCLK since the calendar was set.
  std::uint64_t cycles() const;
  std::uint32_t time_register() const;
  std::uint32_t date_register() const;
  void set_calendar();
  void write_status(std::uint32_t value);
  void plan_wake_up();
  void wake_up_at(Ticks when);
  void plan_second();
  void second_over();
  bool alarm_matches(std::uint32_t alarm) const;
  void update();

  Machine& machine_;
  Scheduler& events_;
  const Rcc& rcc_;
  ExternalLines& external_lines_;
  std::uint32_t control_ = 0, status_ = 0, prescaler_ = 0, reload_ = 0, written_time_ = 0, written_date_ = 0;
  std::array<std::uint32_t, 2> alarms_{};
  std::array<std::uint32_t, 20> backup_{};
  std::int64_t set_to_s_ = 0;  ///< seconds since 2000-01-01 00:00
  Ticks set_at_ = 0, synchronised_at_ = 0, initialised_at_ = 0;
  Ticks wakes_at_ = never;
  Ticks frozen_at_ = never;
  unsigned unlock_step_ = 0;
  Scheduler::Id wake_up_ = 0, second_ = 0;
};

}  // namespace inkwell::virtual_board
