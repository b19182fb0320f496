// USART1, USART2, USART3, UART4, UART5 and USART6 (RM0090, "Universal synchronous asynchronous receiver transmitter").
// The model transfers whole characters with the real duration of an asynchronous frame. The pin levels do not change.
#pragma once

#include <cstdint>
#include <deque>
#include <functional>

#include "boards/stm32f405/memory/register_block.hpp"
#include "boards/stm32f405/peripherals/lines.hpp"

namespace inkwell::virtual_board {

struct UsartRegisters {
  struct : Register {
    Field pe{"PE", 0, 1, Access::r}, fe{"FE", 1, 1, Access::r}, nf{"NF", 2, 1, Access::r}, ore{"ORE", 3, 1, Access::r},
        idle{"IDLE", 4, 1, Access::r}, rxne{"RXNE", 5, 1, Access::rc_w0}, tc{"TC", 6, 1, Access::rc_w0},
        txe{"TXE", 7, 1, Access::r}, lbd{"LBD", 8, 1, Access::rc_w0}, cts{"CTS", 9, 1, Access::rc_w0};
  } sr{{"SR", 0x00, 0xC0}};
  struct : Register {
    Field dr{"DR", 0, 9};
  } dr{{"DR", 0x04}};
  struct : Register {
    Field div_fraction{"DIV_Fraction", 0, 4}, div_mantissa{"DIV_Mantissa", 4, 12};
  } brr{{"BRR", 0x08}};
  struct : Register {
    Field sbk{"SBK", 0}, rwu{"RWU", 1}, re{"RE", 2}, te{"TE", 3}, idleie{"IDLEIE", 4}, rxneie{"RXNEIE", 5},
        tcie{"TCIE", 6}, txeie{"TXEIE", 7}, peie{"PEIE", 8}, ps{"PS", 9}, pce{"PCE", 10}, wake{"WAKE", 11}, m{"M", 12},
        ue{"UE", 13}, over8{"OVER8", 15};
  } cr1{{"CR1", 0x0C}};
  struct : Register {
    Field add{"ADD", 0, 4}, lbdl{"LBDL", 5}, lbdie{"LBDIE", 6}, lbcl{"LBCL", 8}, cpha{"CPHA", 9}, cpol{"CPOL", 10},
        clken{"CLKEN", 11}, stop{"STOP", 12, 2}, linen{"LINEN", 14};
  } cr2{{"CR2", 0x10}};
  struct : Register {
    Field eie{"EIE", 0}, iren{"IREN", 1}, irlp{"IRLP", 2}, hdsel{"HDSEL", 3}, nack{"NACK", 4}, scen{"SCEN", 5},
        dmar{"DMAR", 6}, dmat{"DMAT", 7}, rtse{"RTSE", 8}, ctse{"CTSE", 9}, ctsie{"CTSIE", 10}, onebit{"ONEBIT", 11};
  } cr3{{"CR3", 0x14}};
  struct : Register {
    Field psc{"PSC", 0, 8}, gt{"GT", 8, 8};
  } gtpr{{"GTPR", 0x18}};
};
inline constexpr UsartRegisters usart_map;

class Usart final : public RegisterBlock, public TimedPart {
 public:
  Usart(Machine& machine, DmaRequests& requests, const PinFunctions& pins, unsigned number, unsigned position,
        bool on_apb2);
  void reset() override;
  void step(Ticks now) override;
  void receive(std::uint8_t byte);
  bool listens() const;
  std::size_t waiting() const { return line_.size(); }
  /// Serves pending DMA requests. Call this function when a DMA stream has been enabled.
  void serve_dma();
  std::function<void(unsigned number, std::uint8_t byte)> on_sent;

 protected:
  std::uint32_t read_word(std::uint32_t offset) override;
  void write_word(std::uint32_t offset, std::uint32_t value) override;
  std::uint32_t stored(std::uint32_t offset) const override;
  std::span<const MapEntry> registers() const override { return shown<usart_map>(); }

 private:
  std::string name() const;
  /// Bit duration in cycles of the bus clock.
  unsigned cycles_of_bit() const;
  Ticks frame_duration() const;
  /// Returns true if the baud rate is valid and a TX pin is configured.
  bool is_heard() const;
  void load_shift_register();
  void take_received();
  void update();

  Machine& machine_;
  DmaRequests& dma_;
  const PinFunctions& pins_;
  unsigned number_, position_;
  bool on_apb2_;
  Timeline::Slot slot_;
  std::uint32_t status_ = usart_map.sr.reset_value, baud_ = 0, control1_ = 0, control2_ = 0, control3_ = 0, guard_ = 0;
  std::uint8_t shift_ = 0, holding_ = 0, received_ = 0;
  bool holding_full_ = false;
  Ticks sent_at_ = never, received_at_ = never;
  std::deque<std::uint8_t> line_;
};

}  // namespace inkwell::virtual_board
