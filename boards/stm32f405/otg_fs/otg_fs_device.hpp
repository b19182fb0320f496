// The OTG_FS core of the STM32F405 in device mode (RM0090, chapter "USB on-the-go full-speed"). The model has a
// register interface to the processor and a transaction interface to the bus. Host mode, DMA and isochronous endpoints
// are not modeled.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "boards/stm32f405/core/exception_numbers.hpp"
#include "boards/stm32f405/core/rules.hpp"
#include "boards/stm32f405/otg_fs/bus.hpp"
#include "boards/stm32f405/otg_fs/word_fifo.hpp"

namespace inkwell::virtual_board {

class OtgFsDevice final : public Peripheral, public BusDevice {
 public:
  static constexpr std::uint32_t base = 0x5000'0000;
  static constexpr std::uint32_t size = 0x4'0000;
  static constexpr unsigned endpoint_count = 4;  ///< IN and OUT each, including endpoint 0
  static constexpr std::size_t packet_memory_words = 320;

  explicit OtgFsDevice(const ChipConnections& chip);
  OtgFsDevice(const OtgFsDevice&) = delete;
  OtgFsDevice& operator=(const OtgFsDevice&) = delete;

  // Peripheral
  std::uint32_t read(std::uint32_t offset, unsigned size_bytes) override;
  void write(std::uint32_t offset, std::uint32_t value, unsigned size_bytes) override;
  void reset() override;
  std::vector<RegisterMap> register_maps(const std::string& name, std::uint32_t at) const override;

  // BusDevice
  std::uint32_t attachment() const override { return pulled_up_ && pins_connected() ? attachments_ : 0; }
  void set_bus_power(bool present) override;
  void begin_reset() override;
  void end_reset() override;
  void start_of_frame(std::uint16_t frame_number) override;
  void suspend() override;
  void resume() override;
  Handshake setup(unsigned address, unsigned endpoint, std::span<const std::byte, 8> request) override;
  Handshake out(unsigned address, unsigned endpoint, bool data1, std::span<const std::byte> data) override;
  InReply in(unsigned address, unsigned endpoint, std::span<std::byte, full_speed_packet_maximum> data) override;
  bool finish_in(unsigned endpoint) override;

 private:
  /// IN direction of an endpoint (device to host).
  struct InEndpoint {
    std::uint32_t control = 0;               ///< DIEPCTL without its command bits
    std::uint32_t interrupts = 0;            ///< DIEPINT except TXFE, which is a level
    std::uint32_t packets = 0;               ///< PKTCNT: packets still to be acknowledged
    std::uint32_t bytes_to_load = 0;         ///< XFRSIZ: decreases as packets are written to the FIFO
    std::uint32_t bytes_to_send = 0;         ///< decreases as packets are acknowledged
    std::uint32_t packet_words_to_load = 0;  ///< rest of the packet that the firmware is writing; 0 between packets
    std::uint32_t packet_bytes_loading = 0;
    std::optional<std::uint32_t> bytes_on_wire;
    Ticks wire_until = 0;  ///< end of the packet and of the time for its handshake
    unsigned packets_in_fifo = 0;
    bool data1 = false;
    bool damaged = false;    ///< the FIFO content has a bad CRC until the FIFO is flushed
    bool disabling = false;  ///< from EPDIS to EPDISD
    Scheduler::Id nak_event = 0, disable_event = 0;
  };
  /// OUT direction of an endpoint (host to device).
  struct OutEndpoint {
    std::uint32_t control = 0;
    std::uint32_t interrupts = 0;
    std::uint32_t packets = 0;  ///< PKTCNT
    std::uint32_t bytes = 0;    ///< XFRSIZ
    bool data1 = false;
    bool disable_pending = false;  ///< EPDIS waits for the global OUT NAK
    bool disabling = false;        ///< from the global OUT NAK to EPDISD
    Scheduler::Id disable_event = 0;
  };

  std::uint32_t read_register(std::uint32_t offset);
  void write_register(std::uint32_t offset, std::uint32_t value);
  std::uint32_t read_global(std::uint32_t offset);
  void write_global(std::uint32_t offset, std::uint32_t value);
  std::uint32_t read_device(std::uint32_t offset);
  void write_device(std::uint32_t offset, std::uint32_t value);
  std::uint32_t read_in_endpoint(std::uint32_t offset);
  std::uint32_t read_out_endpoint(std::uint32_t offset);
  void write_in_endpoint(std::uint32_t offset, std::uint32_t value);
  void write_out_endpoint(std::uint32_t offset, std::uint32_t value);
  void reset_core();

  void write_reset_control(std::uint32_t value);
  void write_device_configuration(std::uint32_t value);
  void write_device_control(std::uint32_t value);
  void write_in_control(unsigned endpoint, std::uint32_t value);
  void write_out_control(unsigned endpoint, std::uint32_t value);
  void disable_in(InEndpoint& endpoint);
  void disable_out(OutEndpoint& endpoint);
  void let_nak_take_effect(InEndpoint& endpoint);
  Ticks free_of_packet(const InEndpoint& endpoint) const;
  std::uint32_t reset_control() const;
  void check_flush(std::uint32_t reset_control_written);
  /// Returns false if the register write is too early and has no effect.
  bool store_may_come(std::uint32_t offset, std::uint32_t value);
  void check_flushed_fifo(std::uint32_t offset, std::uint32_t value);
  void check_disabled_endpoints(std::uint32_t offset, std::uint32_t value);
  bool is_flushed(unsigned fifo) const;
  void cancel_commands();
  void check_in_transfer(unsigned endpoint);
  void check_out_transfer(unsigned endpoint);
  bool armed_by_cnak(unsigned endpoint, std::uint32_t control_written) const;

  std::uint32_t pop_receive_status();
  std::uint32_t pop_receive_data();
  void push_transmit_data(unsigned endpoint, std::uint32_t word);
  void flush_transmit(unsigned number);
  void note_memory_layout();

  void push_status(unsigned endpoint, unsigned packet_status, std::size_t bytes, bool data1);
  void push_data(std::span<const std::byte> data);
  std::size_t receive_words_free() const;
  void end_setup_stage();
  void lose_setup_done_word();
  void note_receive_fifo_check();

  unsigned in_packet_maximum(unsigned endpoint) const;
  unsigned transmit_fifo_of(unsigned endpoint) const;
  std::size_t receive_depth() const;
  std::size_t transmit_depth(unsigned number) const;
  std::size_t transmit_words_free(unsigned endpoint) const;
  bool transmit_empty_level(unsigned endpoint) const;
  bool answers(unsigned address, unsigned endpoint) const;
  unsigned programmed_address() const;

  std::uint32_t interrupt_status() const;
  std::uint32_t in_interrupts(unsigned endpoint) const;
  std::uint32_t endpoint_interrupts() const;
  void update_interrupt();
  bool has_session() const;
  void update_pull_up();
  void write_usb_configuration(std::uint32_t value);
  bool pins_connected() const;
  bool clock_is_exact() const;
  /// Returns true if the firmware has not yet acknowledged a bus reset. Actions that were valid before the bus reset
  /// are allowed until the firmware acknowledges the bus reset.
  bool reset_is_unseen() const;
  void check_connection();
  void check_bus_power();
  void check_core();
  void check_turnaround();
  /// Logs an access to an unmodeled register and returns 0.
  std::uint32_t not_modelled(std::uint32_t offset, bool is_write, std::uint32_t value);
  void note(const char* sentence, std::uint32_t offset, bool is_write, std::uint32_t value);

  Scheduler& scheduler_;
  InterruptController& interrupts_;
  UnmodelledLog& log_;
  RuleKeeper& rules_;
  const ChipState& chip_;
  TriggerLines& triggers_;

  // Registers.
  std::uint32_t otg_interrupts_ = 0;                           // GOTGINT
  std::uint32_t bus_configuration_ = 0;                        // GAHBCFG
  std::uint32_t usb_configuration_ = 0;                        // GUSBCFG
  std::uint32_t latched_interrupts_ = 0;                       // GINTSTS, the bits that are cleared by writing 1
  std::uint32_t interrupt_mask_ = 0;                           // GINTMSK
  std::uint32_t receive_size_ = 0;                             // GRXFSIZ
  std::array<std::uint32_t, endpoint_count> transmit_size_{};  // DIEPTXF0..3
  std::uint32_t core_configuration_ = 0;                       // GCCFG
  std::uint32_t core_id_ = 0;                                  // CID
  std::uint32_t device_configuration_ = 0;                     // DCFG
  std::uint32_t device_control_ = 0;                           // DCTL
  std::uint32_t in_mask_ = 0;                                  // DIEPMSK
  std::uint32_t out_mask_ = 0;                                 // DOEPMSK
  std::uint32_t endpoint_mask_ = 0;                            // DAINTMSK
  std::uint32_t in_empty_mask_ = 0;                            // DIEPEMPMSK
  std::uint32_t bus_discharge_ = 0;                            // DVBUSDIS
  std::uint32_t bus_pulse_ = 0;                                // DVBUSPULSE
  std::uint32_t power_control_ = 0;                            // PCGCCTL

  std::array<InEndpoint, endpoint_count> in_{};
  std::array<OutEndpoint, endpoint_count> out_{};
  WordFifo receive_;
  std::array<WordFifo, endpoint_count> transmit_{};

  std::uint32_t receive_data_words_ = 0;      ///< data words at the head of the receive FIFO, after their status word
  std::optional<unsigned> writing_endpoint_;  ///< set if the last access was a FIFO write of this endpoint
  bool layout_changed_ = true;
  bool global_in_nak_ = false;
  bool global_out_nak_requested_ = false;
  bool global_out_nak_effective_ = false;

  unsigned address_ = 0;                ///< address on the bus; changes to DCFG.DAD after a status stage
  bool control_transfer_open_ = false;  ///< from a SETUP packet to its status stage
  bool setup_stage_open_ = false;       ///< from a SETUP packet to the next token: the setup-done word is not written
                                        ///< yet
  bool setup_done_unpopped_ = false;    ///< from a SETUP packet until the firmware pops its setup-done word
  bool setup_done_lost_ = false;        ///< CNAK was written before the pop: the word is lost
  bool setup_was_seen_ = false;         ///< the firmware has read a non-empty receive FIFO since the last SETUP
  Ticks receive_found_empty_at_ = 0;    ///< last time at which the firmware found the FIFO empty
  unsigned setup_packets_allowed_ = 0;  ///< DOEPTSIZ0.STUPCNT
  bool bus_power_ = false;
  bool pulled_up_ = false, bus_is_silent_ = true;  ///< silent until the first reset ends, and in each reset
  bool suspended_ = false;
  std::uint32_t attachments_ = 0;
  std::uint16_t frame_number_ = 0;
  Scheduler::Id end_of_periodic_frame_ = 0;
  bool interrupt_asserted_ = false;
  Ticks core_reset_until_ = 0;
  Ticks receive_flush_until_ = 0;
  Ticks transmit_flush_until_ = 0;
  unsigned fifo_flushed_ = 0;           ///< TXFNUM of the flush
  bool reset_since_selection_ = false;  ///< CSRST was written after PHYSEL
  Ticks device_forced_at_ = 0;          ///< time at which FDMOD was set
  Scheduler::Id connection_check_ = 0;
  Scheduler::Id pull_up_check_ = 0;
};

}  // namespace inkwell::virtual_board
