/*
** STORE, a library with a block of memory whose content and address are known: MM, MD and CS are given it to work on.
** With STORE_ADDRESS the block lies there, where the same library has it in cfepy; the linker is told of it, too.
*/
#ifdef STORE_ADDRESS
#define _GNU_SOURCE
#include <sys/mman.h>
#endif
#include "cfe.h"

#define SIZE 8192

#ifdef STORE_ADDRESS
extern uint8 STORE_Block[SIZE];
#else
uint8 STORE_Block[SIZE] __attribute__((aligned(4096)));
#endif

CFE_Status_t STORE_Init(CFE_ES_LibId_t id)
{
    size_t at;

#ifdef STORE_ADDRESS
    if (mmap((void *)STORE_ADDRESS, SIZE, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS | MAP_FIXED_NOREPLACE, -1,
             0) == MAP_FAILED)
    {
        return CFE_STATUS_EXTERNAL_RESOURCE_FAIL;
    }
#endif
    for (at = 0; at < SIZE; at++)
    {
        STORE_Block[at] = (uint8)(at * 7 + at / 256);
    }
    return CFE_SUCCESS;
}
