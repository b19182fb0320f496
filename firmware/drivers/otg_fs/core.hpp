// Common definitions of the OTG_FS driver.
#pragma once

#include <cstdint>

#include <board/board.hpp>
#include "firmware/drivers/interrupts.hpp"
#include "firmware/drivers/otg_fs/otg_fs.hpp"
#include "firmware/drivers/pins.hpp"
#include "firmware/registers/peripherals.hpp"

namespace inkwell::drivers {

using Core = RegistersOf<OtgFs, registers::OTG_FS_GLOBAL>;
using Device = RegistersOf<OtgFs, registers::OTG_FS_DEVICE>;
using Power = RegistersOf<OtgFs, registers::OTG_FS_PWRCLK>;
using UsbSupply = DigitalInput<OtgFs, board::facts.usb_supply>;

/// Time limit for an answer of the core. The core answers within one packet time, 50 us.
inline constexpr std::uint32_t core_answer_cycles = board::processor_Hz / 1'000'000 * 60;

}  // namespace inkwell::drivers
