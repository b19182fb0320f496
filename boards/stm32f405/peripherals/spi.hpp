// SPI1 to SPI3 without a connected device (RM0090, "Serial peripheral interface"). A master sends frames with correct
// timing and receives only 1 bits. In slave mode, the controller receives no clock. I2S and CRC are not modeled.
#pragma once

#include <functional>

#include "boards/stm32f405/memory/register_block.hpp"
#include "boards/stm32f405/peripherals/lines.hpp"

namespace inkwell::virtual_board {

struct SpiRegisters {
  struct : Register {
    Field cpha{"CPHA", 0}, cpol{"CPOL", 1}, mstr{"MSTR", 2}, br{"BR", 3, 3}, spe{"SPE", 6}, lsbfirst{"LSBFIRST", 7},
        ssi{"SSI", 8}, ssm{"SSM", 9}, rxonly{"RXONLY", 10}, dff{"DFF", 11}, crcnext{"CRCNEXT", 12}, crcen{"CRCEN", 13},
        bidioe{"BIDIOE", 14}, bidimode{"BIDIMODE", 15};
  } cr1{{"CR1", 0x00}};
  struct : Register {
    Field rxdmaen{"RXDMAEN", 0}, txdmaen{"TXDMAEN", 1}, ssoe{"SSOE", 2}, frf{"FRF", 4}, errie{"ERRIE", 5},
        rxneie{"RXNEIE", 6}, txeie{"TXEIE", 7};
  } cr2{{"CR2", 0x04}};
  struct : Register {
    Field rxne{"RXNE", 0, 1, Access::r}, txe{"TXE", 1, 1, Access::r}, crcerr{"CRCERR", 4, 1, Access::rc_w0},
        modf{"MODF", 5, 1, Access::r}, ovr{"OVR", 6, 1, Access::r}, bsy{"BSY", 7, 1, Access::r};
  } sr{{"SR", 0x08, 0x0002}};
  struct : Register {
    Field dr{"DR", 0, 16};
  } dr{{"DR", 0x0C}};
  struct : Register {
    Field crcpoly{"CRCPOLY", 0, 16};
  } crcpr{{"CRCPR", 0x10, 0x0007}};
  struct : Register {
    Field i2scfg{"I2SCFG", 8, 2}, i2se{"I2SE", 10}, i2smod{"I2SMOD", 11};
  } i2scfgr{{"I2SCFGR", 0x1C}};
};
inline constexpr SpiRegisters spi;

class Spi final : public RegisterBlock {
 public:
  Spi(Machine& machine, Scheduler& events, DmaRequests& requests, unsigned number, unsigned position, bool on_apb2)
      : machine_(machine), events_(events), dma_(requests), number_(number), position_(position), on_apb2_(on_apb2) {}
  void reset() override;
  /// Serves pending DMA requests. Call this function when a DMA stream has been enabled.
  void serve_dma();

 protected:
  std::uint32_t read_word(std::uint32_t offset) override;
  void write_word(std::uint32_t offset, std::uint32_t value) override;
  std::uint32_t stored(std::uint32_t offset) const override;
  std::span<const MapEntry> registers() const override { return shown<spi>(); }

 private:
  std::string name() const { return "SPI" + std::to_string(number_); }
  Ticks frame_duration() const;
  /// Starts an SPI frame if data is waiting and no frame is in progress.
  void start_frame();
  void end_frame();
  void update();

  Machine& machine_;
  Scheduler& events_;
  DmaRequests& dma_;
  unsigned number_, position_;
  bool on_apb2_;
  std::uint32_t control1_ = 0, control2_ = 0, status_ = spi.sr.reset_value, polynomial_ = spi.crcpr.reset_value,
                i2s_ = 0, received_ = 0;
  Scheduler::Id frame_ = 0;  ///< 0: no frame in progress
};

}  // namespace inkwell::virtual_board
