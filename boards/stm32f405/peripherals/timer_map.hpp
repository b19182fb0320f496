// Registers of the timers (RM0090, TIMx_CR1 to TIMx_DMAR). TimerTraits selects the registers that a timer has.
#pragma once

#include "boards/stm32f405/core/register_map.hpp"

namespace inkwell::virtual_board {

/// CCMR1 or CCMR2, for two channels each. Input fields and output fields overlap.
template <unsigned lowest>
struct CaptureCompareMode : Register {
  Field ccs{"CC#S", 0, 2, Access::rw, {2, 8, lowest}};
  Field ocfe{"OC#FE", 2, 1, Access::rw, {2, 8, lowest}};
  Field ocpe{"OC#PE", 3, 1, Access::rw, {2, 8, lowest}};
  Field ocm{"OC#M", 4, 3, Access::rw, {2, 8, lowest}};
  Field occe{"OC#CE", 7, 1, Access::rw, {2, 8, lowest}};
  Field icpsc{"IC#PSC", 2, 2, Access::rw, {2, 8, lowest}};
  Field icf{"IC#F", 4, 4, Access::rw, {2, 8, lowest}};
};

struct TimerRegisters {
  struct : Register {
    Field cen{"CEN", 0}, udis{"UDIS", 1}, urs{"URS", 2}, opm{"OPM", 3}, dir{"DIR", 4}, cms{"CMS", 5, 2},
        arpe{"ARPE", 7}, ckd{"CKD", 8, 2};
  } cr1{{"CR1", 0x00}};
  struct : Register {
    Field ccpc{"CCPC", 0}, ccus{"CCUS", 2}, ccds{"CCDS", 3}, mms{"MMS", 4, 3}, ti1s{"TI1S", 7};
    Field ois{"OIS#", 8, 1, Access::rw, {4, 2, 1}}, oisn{"OIS#N", 9, 1, Access::rw, {3, 2, 1}};
  } cr2{{"CR2", 0x04}};
  struct : Register {
    Field sms{"SMS", 0, 3}, ts{"TS", 4, 3}, msm{"MSM", 7}, etf{"ETF", 8, 4}, etps{"ETPS", 12, 2}, ece{"ECE", 14},
        etp{"ETP", 15};
  } smcr{{"SMCR", 0x08}};
  struct : Register {
    Field uie{"UIE", 0}, ccie{"CC#IE", 1, 1, Access::rw, {4, 1, 1}}, comie{"COMIE", 5}, tie{"TIE", 6}, bie{"BIE", 7};
    Field ude{"UDE", 8}, ccde{"CC#DE", 9, 1, Access::rw, {4, 1, 1}}, comde{"COMDE", 13}, tde{"TDE", 14};
  } dier{{"DIER", 0x0C}};
  struct : Register {
    Field uif{"UIF", 0, 1, Access::rc_w0}, ccif{"CC#IF", 1, 1, Access::rc_w0, {4, 1, 1}},
        comif{"COMIF", 5, 1, Access::rc_w0}, tif{"TIF", 6, 1, Access::rc_w0}, bif{"BIF", 7, 1, Access::rc_w0},
        ccof{"CC#OF", 9, 1, Access::rc_w0, {4, 1, 1}};
  } sr{{"SR", 0x10}};
  struct : Register {
    Field ug{"UG", 0, 1, Access::w}, ccg{"CC#G", 1, 1, Access::w, {4, 1, 1}}, comg{"COMG", 5, 1, Access::w},
        tg{"TG", 6, 1, Access::w}, bg{"BG", 7, 1, Access::w};
  } egr{{"EGR", 0x14}};
  CaptureCompareMode<1> ccmr1{{"CCMR1", 0x18}};
  CaptureCompareMode<3> ccmr2{{"CCMR2", 0x1C}};
  struct : Register {
    Field cce{"CC#E", 0, 1, Access::rw, {4, 4, 1}}, ccp{"CC#P", 1, 1, Access::rw, {4, 4, 1}},
        ccne{"CC#NE", 2, 1, Access::rw, {3, 4, 1}}, ccnp{"CC#NP", 3, 1, Access::rw, {4, 4, 1}};
  } ccer{{"CCER", 0x20}};
  Register cnt{"CNT", 0x24};  ///< like PSC and ARR: 16 or 32 bits, depending on the timer
  struct : Register {
    Field psc{"PSC", 0, 16};
  } psc{{"PSC", 0x28}};
  Register arr{"ARR", 0x2C};
  struct : Register {
    Field rep{"REP", 0, 8};
  } rcr{{"RCR", 0x30}};
  Register ccr{"CCR#", 0x34, 0, {4, 4, 1}};
  struct : Register {
    Field dtg{"DTG", 0, 8}, lock{"LOCK", 8, 2}, ossi{"OSSI", 10}, ossr{"OSSR", 11}, bke{"BKE", 12}, bkp{"BKP", 13},
        aoe{"AOE", 14}, moe{"MOE", 15};
  } bdtr{{"BDTR", 0x44}};
  struct : Register {
    Field dba{"DBA", 0, 5}, dbl{"DBL", 8, 5};
  } dcr{{"DCR", 0x48}};
  struct : Register {
    Field dmab{"DMAB", 0, 16};
  } dmar{{"DMAR", 0x4C}};
  Register option{"OR", 0x50};  ///< of TIM2, TIM5 and TIM11, each with different fields
};
inline constexpr TimerRegisters tim;
/// TIM2_OR: source of ITR1.
inline constexpr Field itr1_remap{"ITR1_RMP", 10, 2};
inline constexpr std::uint32_t itr1_is_otg_fs_sof = 2;
/// Value of CCMRx.CCxS that selects capture by the trigger input TRC.
inline constexpr std::uint32_t trigger_input = 3;

/// CCMRx.OCxM
enum OutputMode : std::uint32_t {
  active_on_match = 1,
  inactive_on_match = 2,
  toggle_on_match = 3,
  force_inactive = 4,
  force_active = 5,
  pwm_1 = 6,
  pwm_2 = 7,
};
/// SMCR.SMS
enum SlaveMode : std::uint32_t {
  encoder_1 = 1,
  encoder_3 = 3,
  reset_mode = 4,
  gated = 5,
  trigger_mode = 6,
  external_clock = 7,
};
/// Values of SMCR.TS. The values 0 to 3 select the internal triggers ITR0 to ITR3.
enum TriggerInput : std::uint32_t {
  input_1_edge = 4,
  filtered_input_1 = 5,
  filtered_input_2 = 6,
  external_input = 7,
};
/// Values of CR2.MMS. The values from compare_reference_1 on select the references of channels 1 to 4.
enum MasterMode : std::uint32_t {
  master_reset = 0,
  master_enable = 1,
  master_update = 2,
  master_compare_pulse = 3,
  compare_reference_1 = 4,
};

}  // namespace inkwell::virtual_board
