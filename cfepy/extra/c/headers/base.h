/* The integers of cFE, ids and small helpers: what every other header here stands on.
 * A header in the folder above has one of NASA's names and leads to the ones here. */
#ifndef CFEPY_BASE_H
#define CFEPY_BASE_H

#include <limits.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* C++ takes the names of functions as C's. */
#ifdef __cplusplus
#define CFEPY_C_BEGIN extern "C" {
#define CFEPY_C_END   }
#else
#define CFEPY_C_BEGIN
#define CFEPY_C_END
#endif

#define _EXTENSION_ __extension__
#define OS_USED __attribute__((used))
#define OS_PRINTF(format_at, values_at) __attribute__((format(printf, format_at, values_at)))
/* Names a type that exists only when the condition holds. */
#define CompileTimeAssert(Condition, Message) typedef char Message[(Condition) ? 1 : -1]

CFEPY_C_BEGIN

typedef int8_t int8;
typedef int16_t int16;
typedef int32_t int32;
typedef int64_t int64;
typedef uint8_t uint8;
typedef uint16_t uint16;
typedef uint32_t uint32;
typedef uint64_t uint64;
typedef intptr_t intptr;
typedef uintptr_t cpuaddr;
typedef size_t cpusize;
typedef ptrdiff_t cpudiff;

/* OSAL's own kinds of numbers, and literals of them. With OSAL_OMIT_DEPRECATED an id is no integer. */
#ifdef OSAL_OMIT_DEPRECATED
typedef struct {
    uint32_t v;
} osal_id_t;
#define CFEPY_OS_ID_VALUE(id) ((id).v)
#else
typedef uint32 osal_id_t;
#define CFEPY_OS_ID_VALUE(id) (id)
#endif
typedef size_t osal_blockcount_t;
typedef long osal_offset_t;
typedef uint32 osal_index_t;
typedef uint32 osal_objtype_t;
typedef int32 osal_status_t;
typedef uint8_t osal_priority_t;
typedef void *osal_stackptr_t;
typedef void (*OS_ArgCallback_t)(osal_id_t object_id, void *arg);

#define OSAL_SIZE_C(X)       ((size_t)(X))
#define OSAL_BLOCKCOUNT_C(X) ((osal_blockcount_t)(X))
#define OSAL_INDEX_C(X)      ((osal_index_t)(X))
#define OSAL_OBJTYPE_C(X)    ((osal_objtype_t)(X))
#define OSAL_STATUS_C(X)     ((osal_status_t)(X))
#define OSAL_PRIORITY_C(X)   ((osal_priority_t){X})
#define OSAL_STACKPTR_C(X)   ((osal_stackptr_t){X})

CFEPY_C_END

#endif
