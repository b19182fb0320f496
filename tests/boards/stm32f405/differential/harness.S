// Runs the programs of programs.py in sequence, with SysTick interrupts. Each program has a separate initial state of
// registers and memory. Prints one line per final state by semihosting: a hash, or the complete state with DUMP.
.syntax unified
.cpu cortex-m4
.fpu fpv4-sp-d16
.thumb

.equ data, 0x20000000          // 1 kB that the programs read and write
.equ data_bytes, 1024
.equ state, 0x20000400         // R0 to R12, LR, APSR, FPSCR, S0 to S31
.equ state_words, 48
.equ variables, 0x20000600     // program number, end of the text, interrupt count
.equ text, 0x20001000
.equ stack, 0x20018000
.equ systick, 0xE000E010

.section .vectors, "a"
.word stack, reset
.rept 13
.word unexpected
.endr
.word interrupt

.section .text
.thumb_func
.global reset
reset:
  ldr r0, =0xE000ED88
  mov r1, #0xF << 20
  str r1, [r0]
  dsb
  isb
  ldr r4, =variables
  movs r0, #0
  str r0, [r4]
  str r0, [r4, #8]
  ldr r0, =text
  str r0, [r4, #4]

next_program:
  // R4: the random seed of the program's state.
  ldr r0, =variables
  ldr r1, [r0]
  ldr r2, =programs
  add r2, r2, r1, lsl #4       // seed, start address, SysTick period, FPSCR
  ldr r4, [r2]
  ldr r5, =data
  ldr r6, =(data_bytes + state_words * 4) / 4
fill:
  bl random
  str r4, [r5], #4
  subs r6, #1
  bne fill
  // Half of the floats are near 1, and half have random bits.
  ldr r5, =state + 16 * 4
  movs r6, #16
near_one:
  ldr r0, [r5]
  bfc r0, #24, #7
  orr r0, r0, #0x3F000000
  str r0, [r5], #8
  subs r6, #1
  bne near_one

  ldr r5, =systick
  ldr r0, [r2, #8]
  str r0, [r5, #4]
  movs r0, #0
  str r0, [r5, #8]
  movs r0, #7
  str r0, [r5]
  ldr r0, [r2, #12]
  vmsr fpscr, r0
  ldr r1, [r2, #4]
  push {r1}                    // start address
  ldr r0, =state
  add r1, r0, #16 * 4
  vldm r1, {s0-s31}
  ldr r1, [r0, #14 * 4]
  msr apsr_nzcvqg, r1
  ldm r0, {r0-r12}
  ldr r8, =data + 512
  mov r10, #32
  ldr lr, =program_ends + 1
  pop {pc}

.thumb_func
.global program_ends
program_ends:
  push {r0-r12, lr}
  mrs r1, apsr
  vmrs r2, fpscr
  ldr r0, =systick
  movs r3, #0
  str r3, [r0]
  ldr r0, =state
  str r1, [r0, #14 * 4]
  str r2, [r0, #15 * 4]
  add r1, r0, #16 * 4
  vstm r1, {s0-s31}
  movs r3, #14
move:
  pop {r1}
  str r1, [r0], #4
  subs r3, #1
  bne move

#ifdef DUMP
  ldr r5, =state
  ldr r6, =state_words
dump:
  ldr r4, [r5], #4
  bl write_word
  subs r6, #1
  bne dump
#endif
  ldr r5, =data
  ldr r6, =(data_bytes + state_words * 4) / 4
  ldr r4, =0x811C9DC5
  ldr r7, =0x01000193
hash:
  ldr r0, [r5], #4
  eors r4, r0
  muls r4, r7
  eor r4, r4, r4, ror #15
  subs r6, #1
  bne hash
  bl write_word

  ldr r0, =variables
  ldr r1, [r0]
  adds r1, #1
  str r1, [r0]
  ldr r2, =program_count
  cmp r1, r2
  bne next_program

  ldr r0, =variables
  ldr r1, [r0, #4]
  movs r2, #0
  strb r2, [r1]
  movs r0, #4                  // SYS_WRITE0
  ldr r1, =text
  bkpt #0xAB
  movs r0, #0x18               // SYS_EXIT
  ldr r1, =0x20026             // ADP_Stopped_ApplicationExit
  bkpt #0xAB

// Appends R4 in hexadecimal digits and a newline to the text. Changes R0 to R3.
write_word:
  ldr r0, =variables
  ldr r1, [r0, #4]
  movs r2, #8
digit:
  ror r4, r4, #28
  and r3, r4, #15
  cmp r3, #10
  ite lo
  addlo r3, #'0'
  addhs r3, #'A' - 10
  strb r3, [r1], #1
  subs r2, #1
  bne digit
  movs r3, #'\n'
  strb r3, [r1], #1
  str r1, [r0, #4]
  bx lr

// R4 becomes the next random number (Marsaglia's xorshift).
random:
  eor r4, r4, r4, lsl #13
  eor r4, r4, r4, lsr #17
  eor r4, r4, r4, lsl #5
  bx lr

// Changes the stacked registers, the flags, the IT state and the FPU. The return must restore these for the program.
.thumb_func
interrupt:
  ldr r0, =variables
  ldr r1, [r0, #8]
  adds r1, #1
  str r1, [r0, #8]
  tst r1, #1
  itete eq
  mvneq r2, r1
  vmovne s0, r1
  moveq r3, r2
  movne r3, #1
  vmov s15, r3
  vcmp.f32 s15, s0
  vmrs apsr_nzcv, fpscr
  subs r12, r3, r1
  bx lr

.thumb_func
unexpected:
  movs r0, #4
  adr r1, words
  bkpt #0xAB
  movs r0, #0x18
  ldr r1, =0x20023             // ADP_Stopped_RunTimeErrorUnknown
  bkpt #0xAB
.align 2
words: .asciz "unexpected exception\n"
.align 2
.ltorg
