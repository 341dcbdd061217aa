/* Devices of the platform support package (iodriver), by name and command. */
#ifndef CFEPY_IODRIVER_H
#define CFEPY_IODRIVER_H

#include "psp.h"

CFEPY_C_BEGIN

typedef struct {
    uint32 PspModuleId;
    uint16 SubsystemId, SubchannelId;
} CFE_PSP_IODriver_Location_t;

typedef union {
    void *Vptr;
    const void *ConstVptr;
    const char *ConstStr;
    uint32 U32;
} CFE_PSP_IODriver_Arg_t;

typedef enum {
    CFE_PSP_IODriver_Direction_DISABLED = 0, CFE_PSP_IODriver_Direction_INPUT_ONLY = 0x01,
    CFE_PSP_IODriver_Direction_OUTPUT_ONLY = 0x02, CFE_PSP_IODriver_Direction_INPUT_OUTPUT = 0x03
} CFE_PSP_IODriver_Direction_t;

enum {
    CFE_PSP_IODriver_NOOP = 0,
    CFE_PSP_IODriver_SET_RUNNING = 1,
    CFE_PSP_IODriver_GET_RUNNING = 2,
    CFE_PSP_IODriver_SET_CONFIGURATION = 3,
    CFE_PSP_IODriver_GET_CONFIGURATION = 4,
    CFE_PSP_IODriver_LOOKUP_SUBSYSTEM = 5,
    CFE_PSP_IODriver_LOOKUP_SUBCHANNEL = 6,
    CFE_PSP_IODriver_SET_DIRECTION = 7,
    CFE_PSP_IODriver_QUERY_DIRECTION = 8,
    CFE_PSP_IODriver_ANALOG_IO_CLASS_BASE = 0x00010000,
    CFE_PSP_IODriver_DISCRETE_IO_CLASS_BASE = 0x00020000,
    CFE_PSP_IODriver_PACKET_IO_CLASS_BASE = 0x00030000,
    CFE_PSP_IODriver_MEMORY_IO_CLASS_BASE = 0x00040000,
    CFE_PSP_IODriver_STREAM_IO_CLASS_BASE = 0x00050000,
    CFE_PSP_IODriver_EXTENDED_BASE = 0x7FFF0000
};

int32 CFE_PSP_IODriver_Command(const CFE_PSP_IODriver_Location_t *Location, uint32 CommandCode,
    CFE_PSP_IODriver_Arg_t Arg);
int32 CFE_PSP_IODriver_FindByName(const char *DriverName, uint32 *PspModuleId);
static inline CFE_PSP_IODriver_Arg_t CFE_PSP_IODriver_VPARG(void *pointer)
{
    return (CFE_PSP_IODriver_Arg_t){.Vptr = pointer};
}
static inline CFE_PSP_IODriver_Arg_t CFE_PSP_IODriver_CONST_VPARG(const void *pointer)
{
    return (CFE_PSP_IODriver_Arg_t){.ConstVptr = pointer};
}
static inline CFE_PSP_IODriver_Arg_t CFE_PSP_IODriver_CONST_STR(const char *text)
{
    return (CFE_PSP_IODriver_Arg_t){.ConstStr = text};
}
static inline CFE_PSP_IODriver_Arg_t CFE_PSP_IODriver_U32ARG(uint32 value)
{
    return (CFE_PSP_IODriver_Arg_t){.U32 = value};
}

typedef int32 CFE_PSP_IODriver_AdcCode_t;

typedef struct {
    uint16 NumChannels;
    CFE_PSP_IODriver_AdcCode_t *Samples;
} CFE_PSP_IODriver_AnalogRdWr_t;

enum {
    CFE_PSP_IODriver_ANALOG_IO_NOOP = CFE_PSP_IODriver_ANALOG_IO_CLASS_BASE,
    CFE_PSP_IODriver_ANALOG_IO_READ_CHANNELS,
    CFE_PSP_IODriver_ANALOG_IO_WRITE_CHANNELS,
    CFE_PSP_IODriver_ANALOG_IO_MAX
};

#define CFE_PSP_IODRIVER_ADC_BITWIDTH 24
typedef uint8 CFE_PSP_IODriver_GpioLevel_t;
enum { CFE_PSP_IODriver_GPIO_LOGIC_LOW = 0, CFE_PSP_IODriver_GPIO_LOGIC_HIGH = 1 };

typedef struct {
    uint16 NumChannels;
    CFE_PSP_IODriver_GpioLevel_t *Samples;
} CFE_PSP_IODriver_GpioRdWr_t;

enum {
    CFE_PSP_IODriver_DISCRETE_IO_NOOP = CFE_PSP_IODriver_DISCRETE_IO_CLASS_BASE,
    CFE_PSP_IODriver_DISCRETE_IO_READ_CHANNELS,
    CFE_PSP_IODriver_DISCRETE_IO_WRITE_CHANNELS,
    CFE_PSP_IODriver_DISCRETE_IO_MAX
};

typedef struct {
    uint32 DeviceAddress, BufferSize;
    const void *BufferMem;
} CFE_PSP_IODriver_WriteMemoryBuffer_t;

typedef struct {
    uint32 DeviceAddress, BufferSize;
    void *BufferMem;
} CFE_PSP_IODriver_ReadMemoryBuffer_t;

enum {
    CFE_PSP_IODriver_MEMORY_IO_NOOP = CFE_PSP_IODriver_MEMORY_IO_CLASS_BASE,
    CFE_PSP_IODriver_MEMORY_IO_READ_32,
    CFE_PSP_IODriver_MEMORY_IO_WRITE_32,
    CFE_PSP_IODriver_MEMORY_IO_READ_16,
    CFE_PSP_IODriver_MEMORY_IO_WRITE_16,
    CFE_PSP_IODriver_MEMORY_IO_READ_8,
    CFE_PSP_IODriver_MEMORY_IO_WRITE_8,
    CFE_PSP_IODriver_MEMORY_IO_READ_BLOCK,
    CFE_PSP_IODriver_MEMORY_IO_WRITE_BLOCK,
    CFE_PSP_IODriver_MEMORY_IO_MAX
};

typedef struct {
    uint32 OutputSize;
    const void *BufferMem;
} CFE_PSP_IODriver_WritePacketBuffer_t;

typedef struct {
    uint32 BufferSize;
    void *BufferMem;
} CFE_PSP_IODriver_ReadPacketBuffer_t;

enum {
    CFE_PSP_IODriver_PACKET_IO_NOOP = CFE_PSP_IODriver_PACKET_IO_CLASS_BASE,
    CFE_PSP_IODriver_PACKET_IO_READ,
    CFE_PSP_IODriver_PACKET_IO_WRITE,
    CFE_PSP_IODriver_PACKET_IO_MAX
};

enum {
    CFE_PSP_IODriver_PACKET_ERROR_BASE = -(CFE_PSP_IODriver_PACKET_IO_CLASS_BASE + 0xFFFF),
    CFE_PSP_IODriver_PACKET_LENGTH_ERROR,
    CFE_PSP_IODriver_PACKET_CRC_ERROR
};

typedef struct {
    uint32 BufferSize;
    const void *BufferMem;
} CFE_PSP_IODriver_WriteStreamBuffer_t;

typedef struct {
    uint32 BufferSize;
    void *BufferMem;
} CFE_PSP_IODriver_ReadStreamBuffer_t;

enum {
    CFE_PSP_IODriver_STREAM_IO_NOOP = CFE_PSP_IODriver_STREAM_IO_CLASS_BASE,
    CFE_PSP_IODriver_STREAM_IO_READ,
    CFE_PSP_IODriver_STREAM_IO_WRITE,
    CFE_PSP_IODriver_STREAM_IO_MAX
};

enum {
    CFE_PSP_IODriver_STREAM_ERROR_BASE = -(CFE_PSP_IODriver_STREAM_IO_CLASS_BASE + 0xFFFF),
    CFE_PSP_IODriver_STREAM_LENGTH_ERROR,
    CFE_PSP_IODriver_STREAM_CRC_ERROR
};

CFEPY_C_END

#endif
