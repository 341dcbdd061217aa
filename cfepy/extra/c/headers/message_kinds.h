/* The three shapes of packets of cFE's services. */
#ifndef CFEPY_MESSAGE_KINDS_H
#define CFEPY_MESSAGE_KINDS_H

#include "es.h"
#include "evs.h"
#include "sb.h"
#include "tbl.h"

#define CFEPY_COMMAND(name)                    \
    typedef struct {                           \
        CFE_MSG_CommandHeader_t CommandHeader; \
    } name##_t
#define CFEPY_COMMAND_WITH(name, payload)      \
    typedef struct {                           \
        CFE_MSG_CommandHeader_t CommandHeader; \
        payload Payload;                       \
    } name##_t
#define CFEPY_TELEMETRY(name, payload)             \
    typedef struct {                               \
        CFE_MSG_TelemetryHeader_t TelemetryHeader; \
        payload Payload;                           \
    } name##_t

#endif
