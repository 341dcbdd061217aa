/* The switch between an application's stack and the host's: x86-64, System V calling convention.
 *
 * engine.h has the members of Coroutine behind the numbers. Registers that a called function keeps are pushed on either
 * side; the modes of floating point (MXCSR and the x87 control word) belong to each side. So does the word that guards
 * stacks (-fstack-protector): the host's is random, and applications have it on their stacks. Above the six saved registers
 * of a stopped coroutine are the return address into the application and its arguments from the seventh on.
 */
    .text

#define KEEP push %rbp; push %rbx; push %r12; push %r13; push %r14; push %r15
#define RESTORE pop %r15; pop %r14; pop %r13; pop %r12; pop %rbx; pop %rbp
#define GUARD %fs:0x28                  /* where compilers expect it */
#define SWAP_GUARD(coroutine) mov GUARD, %rax; mov 256(coroutine), %rcx; mov %rcx, GUARD; mov %rax, 256(coroutine)

    .globl engine_resume
    .hidden engine_resume
    .type engine_resume, @function
engine_resume:                          /* rdi: the coroutine */
    KEEP
    mov %rsp, 72(%rdi)
    stmxcsr 168(%rdi)
    fnstcw 172(%rdi)
    ldmxcsr 176(%rdi)
    fldcw 180(%rdi)
    SWAP_GUARD(%rdi)
    mov 64(%rdi), %rsp
    mov 80(%rdi), %rax
    mov 184(%rdi), %rdx
    movsd 160(%rdi), %xmm0
    cmpq $0, 264(%rdi)
    je 1f
    movq $0, 264(%rdi)
    fldt 272(%rdi)
1:  xor %ecx, %ecx                      /* nothing of the host's gets into an application, not even by chance */
    xor %esi, %esi
    xor %edi, %edi
    xor %r8d, %r8d
    xor %r9d, %r9d
    xor %r10d, %r10d
    xor %r11d, %r11d
    .irp number, 1,2,3,4,5,6,7,8,9,10,11,12,13,14,15
    pxor %xmm\number, %xmm\number
    .endr
    RESTORE
    ret
    .size engine_resume, . - engine_resume

    .globl engine_reenter
    .hidden engine_reenter
    .type engine_reenter, @function
engine_reenter:                         /* rdi: a coroutine that a signal stopped; goes on in the handler of the next */
    KEEP
    mov %rsp, 72(%rdi)
    stmxcsr 168(%rdi)
    fnstcw 172(%rdi)
    SWAP_GUARD(%rdi)
    sub $8, %rsp
    call faults_raise
    ud2
    .size engine_reenter, . - engine_reenter

    .globl engine_call
    .hidden engine_call
    .type engine_call, @function
engine_call:                            /* a stub came here with the number of its function in r11 */
    mov running(%rip), %r10
    KEEP
    mov %rdi, 0(%r10)
    mov %rsi, 8(%r10)
    mov %rdx, 16(%r10)
    mov %rcx, 24(%r10)
    mov %r8, 32(%r10)
    mov %r9, 40(%r10)
    movsd %xmm0, 96(%r10)
    movsd %xmm1, 104(%r10)
    movsd %xmm2, 112(%r10)
    movsd %xmm3, 120(%r10)
    movsd %xmm4, 128(%r10)
    movsd %xmm5, 136(%r10)
    movsd %xmm6, 144(%r10)
    movsd %xmm7, 152(%r10)
    mov %r11, 88(%r10)
    SWAP_GUARD(%r10)
    mov %rsp, 64(%r10)
    stmxcsr 176(%r10)
    fnstcw 180(%r10)
    mov 72(%r10), %rsp
    ldmxcsr 168(%r10)
    fldcw 172(%r10)
    RESTORE
    ret
    .size engine_call, . - engine_call

    .globl engine_land
    .hidden engine_land
    .type engine_land, @function
engine_land:                            /* a signal handler put the host's stack pointer into rsp */
    mov running(%rip), %r10
    cld
    ldmxcsr 168(%r10)
    fninit
    fldcw 172(%r10)
    SWAP_GUARD(%r10)
    RESTORE
    ret
    .size engine_land, . - engine_land

    .globl engine_try
    .hidden engine_try
    .type engine_try, @function
engine_try:                             /* try(coroutine, function, with): calls function(coroutine, with); 0, or 1 when a
                                           signal handler ended it, with the host's modes */
    KEEP
    push 288(%rdi)                      /* one may be tried in another; and the stack is aligned with that */
    mov %rsp, 288(%rdi)
    push %rdi
    push %rdi
    mov %rsi, %rax
    mov %rdx, %rsi
    call *%rax
    pop %rdi
    pop %rdi
    xor %eax, %eax
1:  pop 288(%rdi)
    RESTORE
    ret
    .globl engine_try_failed
    .hidden engine_try_failed
engine_try_failed:                      /* the handler put what is in 288 into rsp */
    mov running(%rip), %rdi
    cld
    ldmxcsr 168(%rdi)
    fninit
    fldcw 172(%rdi)
    mov $1, %eax
    jmp 1b
    .size engine_try, . - engine_try

    .globl engine_begin
    .hidden engine_begin
    .type engine_begin, @function
engine_begin:                           /* first entry: r12 the function, r13, r14, r15 and rbx its arguments, rbp the fifth;
                                           on the stack the sixth, and where the function returns to */
    mov %r13, %rdi
    mov %r14, %rsi
    mov %r15, %rdx
    mov %rbx, %rcx
    mov %rbp, %r8
    mov 0(%rsp), %r9
    xor %eax, %eax
    xor %ebp, %ebp
    push 8(%rsp)
    jmp *%r12
    .size engine_begin, . - engine_begin

    .globl engine_copy
    .hidden engine_copy
    .type engine_copy, @function
engine_copy:                            /* copy(to, from, size): 0, or 1 when the memory is not there */
    mov %rdx, %rcx
    xor %eax, %eax
    rep movsb
    ret
    .globl engine_copy_end
    .hidden engine_copy_end
engine_copy_end:
    .globl engine_copy_failed
    .hidden engine_copy_failed
engine_copy_failed:
    mov $1, %eax
    ret
    .size engine_copy, . - engine_copy

    .section .note.GNU-stack, "", @progbits
