// Without external circuits, the peripherals still report an event or an error to a waiting driver.
#include "tests/boards/stm32f405/firmware/support.hpp"

namespace {

constexpr std::uint32_t spi1 = 0x40013000, i2c1 = 0x40005400, can1 = 0x40006400, dac = 0x40007400, rtc = 0x40002800,
                        pwr = 0x40007000, exti = 0x40013C00, dma2 = 0x40026400, bdcr = 0x40023870;
volatile std::uint32_t interrupts = 0;

/// Returns false after a time limit.
bool wait_for(std::uint32_t address, std::uint32_t mask, std::uint32_t value) {
  for (unsigned i = 0; i < 100'000; ++i)
    if ((word(address) & mask) == value) return true;
  return false;
}

void use_spi() {
  word(spi1) = 1 << 2 | 1 << 6 | 3 << 8 | 2 << 3;  // master, on, NSS by software, PCLK / 8
  word(spi1 + 0xC) = 0x5A;
  const bool busy = (word(spi1 + 8) & 1 << 7) != 0;
  results[1] = busy && wait_for(spi1 + 8, 1, 1);
  results[2] = word(spi1 + 0xC);
  // Five frames by DMA in both directions.
  static std::uint8_t received[8];
  static const std::uint8_t sent[5] = {1, 2, 3, 4, 5};
  word(dma2 + 0x10 + 0x18 * 2 + 8) = spi1 + 0xC;
  word(dma2 + 0x10 + 0x18 * 2 + 0xC) = reinterpret_cast<std::uint32_t>(received);
  word(dma2 + 0x10 + 0x18 * 2 + 4) = 5;
  word(dma2 + 0x10 + 0x18 * 2) = 3u << 25 | 1 << 10 | 1;
  word(dma2 + 0x10 + 0x18 * 3 + 8) = spi1 + 0xC;
  word(dma2 + 0x10 + 0x18 * 3 + 0xC) = reinterpret_cast<std::uint32_t>(sent);
  word(dma2 + 0x10 + 0x18 * 3 + 4) = 5;
  word(dma2 + 0x10 + 0x18 * 3) = 3u << 25 | 1 << 10 | 1 << 6 | 1;
  start_cycle_counter();
  word(spi1 + 4) = 3;
  results[3] = wait_for(dma2, 1 << 21, 1 << 21);  // TCIF2
  results[4] = cycles();
  results[5] = received[0] + received[4] + received[5];
}

void use_i2c() {
  word(i2c1 + 4) = 16 | 1 << 8;
  word(i2c1 + 0x1C) = 80;
  word(i2c1) = 1;
  word(i2c1) = 1 | 1 << 8;
  results[6] = wait_for(i2c1 + 0x14, 1, 1);
  set_handler(interrupt(32), [] {
    interrupts = interrupts + 1;
    results[8] = word(i2c1 + 0x14);
    word(i2c1 + 0x14) = 0;
  });
  enable_interrupt(32, 1);
  word(i2c1 + 0x10) = 0xA0;
  for (unsigned i = 0; i < 10'000 && interrupts == 0; ++i) {
  }
  results[7] = interrupts;
  word(i2c1) = 1 | 1 << 9;
  results[9] = wait_for(i2c1 + 0x18, 2, 0);
}

void use_can() {
  word(can1) = 1;
  results[10] = wait_for(can1 + 4, 3, 1);
  word(can1 + 0x1C) = 1 << 20 | 4 << 16 | 3;
  word(can1) = 0;
  results[11] = wait_for(can1 + 4, 3, 0);
  word(can1 + 0x180) = 0x123u << 21 | 1;
  results[12] = wait_for(can1 + 0x18, 2, 2);  // error passive
  results[13] = word(can1 + 0x18);
  word(can1 + 8) = 1 << 7;
  results[14] = wait_for(can1 + 8, 1 << 26 | 1, 1 << 26 | 1);
}

void use_clock() {
  word(pwr) |= 1 << 8;
  word(0x40023874) = 1;  // LSI
  wait_for(0x40023874, 2, 2);
  word(bdcr) = 2 << 8 | 1 << 15;
  word(rtc + 0x24) = 0xCA;
  word(rtc + 0x24) = 0x53;
  word(rtc + 0xC) = 1 << 7;
  results[20] = wait_for(rtc + 0xC, 1 << 6, 1 << 6);
  word(rtc + 0x10) = 31 << 16 | 9;  // 32 kHz / 32 / 10: an RTC second lasts 10 ms
  word(rtc + 0x00) = 0x235958;
  word(rtc + 0x04) = 0x240228;  // 28 February 2024
  word(rtc + 0xC) = 0;
  results[21] = wait_for(rtc + 0xC, 1 << 5, 1 << 5);
  word(rtc + 0x1C) = 1u << 31 | 1 << 23 | 1 << 15;  // alarm A at second 0 of each minute
  word(exti) = 1 << 17 | 1 << 22;
  word(exti + 8) = 1 << 17 | 1 << 22;
  set_handler(interrupt(41), [] {
    results[22] = word(rtc);
    results[23] = word(rtc + 4);
    word(rtc + 0xC) = 0;
    word(exti + 0x14) = 1 << 17;
    interrupts = interrupts + 1;
  });
  set_handler(interrupt(3), [] {
    results[24] = results[24] + 1;
    word(rtc + 0xC) = 0;
    word(exti + 0x14) = 1 << 22;
  });
  interrupts = 0;
  results[24] = 0;
  enable_interrupt(41, 1);
  enable_interrupt(3, 1);
  word(rtc + 0x14) = 31;  // 32 counts at 2 kHz: every 16 ms
  word(rtc + 8) = 1 << 8 | 1 << 12 | 1 << 10 | 1 << 14;
  word(rtc + 0x50) = 0xB0;
  while (interrupts == 0 || results[24] < 2) wait_for_interrupt();
  results[25] = word(rtc + 0x50);
  word(rtc + 0x24) = 0xFF;
  word(rtc + 0x14) = 5;
  results[26] = word(rtc + 0x14);
}

}  // namespace

void run() {
  word(rcc::apb1enr) |= 1 << 21 | 1 << 25 | 1 << 28 | 1 << 29;
  word(rcc::apb2enr) |= 1 << 12;
  word(rcc::ahb1enr) |= 1 << 22;
  use_spi();
  use_i2c();
  use_can();
  word(dac) = 1 | 1 << 18;
  word(dac + 0x20) = 0x0ABC'0123;
  results[15] = word(dac + 0x2C);
  results[16] = word(dac + 0x30);
  word(dac + 4) = 2;
  results[17] = word(dac + 0x30);
  use_clock();
  results[0] = finished;
  for (;;) wait_for_interrupt();
}
