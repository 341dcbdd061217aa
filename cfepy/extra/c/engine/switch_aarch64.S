/* The switch between an application's stack and the host's: AArch64, AAPCS64.
 *
 * engine.h has the members of Coroutine behind the numbers. Registers that a called function keeps are stored on either
 * side, x19 to x30 and d8 to d15, 20 words; the modes of floating point (FPCR and FPSR) belong to each side. Above the 20
 * words of a stopped coroutine are the arguments of its call from the ninth on; among them, x30 is the return address
 * into the application.
 */
    .text

    .macro KEEP
    sub sp, sp, #160
    stp x19, x20, [sp]
    stp x21, x22, [sp, #16]
    stp x23, x24, [sp, #32]
    stp x25, x26, [sp, #48]
    stp x27, x28, [sp, #64]
    stp x29, x30, [sp, #80]
    stp d8, d9, [sp, #96]
    stp d10, d11, [sp, #112]
    stp d12, d13, [sp, #128]
    stp d14, d15, [sp, #144]
    .endm

    .macro RESTORE
    ldp x19, x20, [sp]
    ldp x21, x22, [sp, #16]
    ldp x23, x24, [sp, #32]
    ldp x25, x26, [sp, #48]
    ldp x27, x28, [sp, #64]
    ldp x29, x30, [sp, #80]
    ldp d8, d9, [sp, #96]
    ldp d10, d11, [sp, #112]
    ldp d12, d13, [sp, #128]
    ldp d14, d15, [sp, #144]
    add sp, sp, #160
    .endm

    .macro KEEP_MODES coroutine, at             /* changes x9 and x10 */
    mrs x9, fpcr
    mrs x10, fpsr
    stp w9, w10, [\coroutine, #\at]
    .endm

    .macro TAKE_MODES coroutine, at
    ldp w9, w10, [\coroutine, #\at]
    msr fpcr, x9
    msr fpsr, x10
    .endm

    .macro VECTORS operation                    /* stp or ldp, all of them, whole */
    \operation q0, q1, [sp, #144]
    \operation q2, q3, [sp, #176]
    \operation q4, q5, [sp, #208]
    \operation q6, q7, [sp, #240]
    \operation q8, q9, [sp, #272]
    \operation q10, q11, [sp, #304]
    \operation q12, q13, [sp, #336]
    \operation q14, q15, [sp, #368]
    \operation q16, q17, [sp, #400]
    \operation q18, q19, [sp, #432]
    \operation q20, q21, [sp, #464]
    \operation q22, q23, [sp, #496]
    \operation q24, q25, [sp, #528]
    \operation q26, q27, [sp, #560]
    \operation q28, q29, [sp, #592]
    \operation q30, q31, [sp, #624]
    .endm

    .macro OTHERS operation                     /* those that a called function may change, but x0, x16 and x17 */
    \operation x1, x2, [sp, #0]
    \operation x3, x4, [sp, #16]
    \operation x5, x6, [sp, #32]
    \operation x7, x8, [sp, #48]
    \operation x9, x10, [sp, #64]
    \operation x11, x12, [sp, #80]
    \operation x13, x14, [sp, #96]
    \operation x15, x18, [sp, #112]
    \operation x29, x30, [sp, #128]
    .endm

    .globl engine_resume
    .hidden engine_resume
    .type engine_resume, %function
engine_resume:                                  /* x0: the coroutine */
    KEEP
    mov x9, sp
    str x9, [x0, #72]
    KEEP_MODES x0, 168
    TAKE_MODES x0, 176
    ldr x9, [x0, #64]
    mov sp, x9
    RESTORE
    ldr d0, [x0, #160]
    ldr x9, [x0, #264]
    cbz x9, 1f
    str xzr, [x0, #264]
    ldr q0, [x0, #272]
1:  ldr x1, [x0, #184]
    ldr x0, [x0, #80]
    .irp number, 2,3,4,5,6,7,8,9,10,11,12,13,14,15,16,17,18 /* nothing of the host's gets into an application */
    mov x\number, #0
    .endr
    .irp number, 1,2,3,4,5,6,7,16,17,18,19,20,21,22,23,24,25,26,27,28,29,30,31
    movi v\number\().2d, #0
    .endr
    ret
    .size engine_resume, . - engine_resume

    .globl engine_reenter
    .hidden engine_reenter
    .type engine_reenter, %function
engine_reenter:                                 /* x0: a coroutine that a signal stopped; goes on in the handler of the next */
    KEEP
    mov x9, sp
    str x9, [x0, #72]
    KEEP_MODES x0, 168
    bl faults_raise
    brk #0
    .size engine_reenter, . - engine_reenter

    .globl engine_call
    .hidden engine_call
    .type engine_call, %function
engine_call:                                    /* a stub came here with the number of its function in x16 */
    adrp x17, running
    ldr x17, [x17, #:lo12:running]
    KEEP
    stp x0, x1, [x17]
    stp x2, x3, [x17, #16]
    stp x4, x5, [x17, #32]
    stp x6, x7, [x17, #48]
    stp d0, d1, [x17, #96]
    stp d2, d3, [x17, #112]
    stp d4, d5, [x17, #128]
    stp d6, d7, [x17, #144]
    add x11, x17, #192                          /* the upper halves, for long double */
    .irp number, 0,1,2,3,4,5,6,7
    st1 {v\number\().d}[1], [x11], #8
    .endr
    str x16, [x17, #88]
    mov x9, sp
    str x9, [x17, #64]
    KEEP_MODES x17, 176
    TAKE_MODES x17, 168
    ldr x9, [x17, #72]
    mov sp, x9
    RESTORE
    ret
    .size engine_call, . - engine_call

    .globl engine_thread_local
    .hidden engine_thread_local
    .type engine_thread_local, %function
engine_thread_local:                            /* where a variable is, from the thread's pointer on, which is 0 for an
                                                   application (image.py): the code that asks keeps all registers but
                                                   x0, x30 and the flags. x0: its descriptor. A stub came here with the
                                                   number of a function in x16; x16 and x17 of the application are on
                                                   the stack. */
    sub sp, sp, #656
    VECTORS stp
    OTHERS stp
    ldr x0, [x0, #8]
    bl engine_call
    str xzr, [sp, #-72]                         /* where KEEP had x30: an address of the host's code, which applications
                                                   would find below their stack */
    VECTORS ldp
    OTHERS ldp
    add sp, sp, #656
    ldp x16, x17, [sp], #16
    ret
    .size engine_thread_local, . - engine_thread_local

    .globl engine_land
    .hidden engine_land
    .type engine_land, %function
engine_land:                                    /* a signal handler put the host's stack pointer into sp */
    adrp x17, running
    ldr x17, [x17, #:lo12:running]
    TAKE_MODES x17, 168
    RESTORE
    ret
    .size engine_land, . - engine_land

    .globl engine_try
    .hidden engine_try
    .type engine_try, %function
engine_try:                                     /* try(coroutine, function, with): calls function(coroutine, with); 0, or 1
                                                   when a signal handler ended it, with the host's modes */
    KEEP
    ldr x9, [x0, #288]                          /* one may be tried in another */
    stp x9, x0, [sp, #-16]!
    mov x9, sp
    str x9, [x0, #288]
    mov x9, x1
    mov x1, x2
    blr x9
    mov w2, #0
1:  ldp x9, x1, [sp], #16
    str x9, [x1, #288]
    mov w0, w2
    RESTORE
    ret
    .globl engine_try_failed
    .hidden engine_try_failed
engine_try_failed:                              /* the handler put what is in 288 into sp */
    adrp x17, running
    ldr x17, [x17, #:lo12:running]
    TAKE_MODES x17, 168
    mov w2, #1
    b 1b
    .size engine_try, . - engine_try

    .globl engine_begin
    .hidden engine_begin
    .type engine_begin, %function
engine_begin:                                   /* first entry: x19 the function, x20 to x25 its arguments, x26 where
                                                   it returns to */
    str xzr, [sp, #-72]                         /* where this address was: of the host, below the stack of the function */
    mov x0, x20
    mov x1, x21
    mov x2, x22
    mov x3, x23
    mov x4, x24
    mov x5, x25
    mov x29, #0
    mov x30, x26
    br x19
    .size engine_begin, . - engine_begin

    .globl engine_copy
    .hidden engine_copy
    .type engine_copy, %function
engine_copy:                                    /* copy(to, from, size): 0, or 1 when the memory is not there */
    subs x2, x2, #16
    b.lo 2f
1:  ldp x3, x4, [x1], #16
    stp x3, x4, [x0], #16
    subs x2, x2, #16
    b.hs 1b
2:  tbz x2, #3, 3f                              /* the last four bits are those of what is left */
    ldr x3, [x1], #8
    str x3, [x0], #8
3:  tbz x2, #2, 4f
    ldr w3, [x1], #4
    str w3, [x0], #4
4:  tbz x2, #1, 5f
    ldrh w3, [x1], #2
    strh w3, [x0], #2
5:  tbz x2, #0, 6f
    ldrb w3, [x1]
    strb w3, [x0]
6:  mov w0, #0
    ret
    .globl engine_copy_end
    .hidden engine_copy_end
engine_copy_end:
    .globl engine_copy_failed
    .hidden engine_copy_failed
engine_copy_failed:
    mov w0, #1
    ret
    .size engine_copy, . - engine_copy

    .section .note.GNU-stack, "", %progbits
