/* cFE 6: small types, headers of packets as structures and as bytes (ccsds.h).
 * Headers have the sizes of cFE 6: 8 bytes of a command, 12 of telemetry (16 in cFE 7). Their bytes are those of cFE 7,
 * and of cFE 6 on a big-endian processor: time big-endian, the function code before the checksum. */
#ifndef CFEPY_CFE6_HEADERS_H
#define CFEPY_CFE6_HEADERS_H

#include "base.h"

#ifndef TRUE
#define TRUE true
#define FALSE false
#endif
#if CFEPY_CFE_6 == 65
typedef uint8 osalbool;
#else
typedef bool osalbool;
#endif
typedef osalbool boolean;
#define OS_PACK     __attribute__((packed))
#define OS_ALIGN(n) __attribute__((aligned(n)))
#if defined(__BYTE_ORDER__) && __BYTE_ORDER__ == __ORDER_BIG_ENDIAN__
#define SOFTWARE_BIG_BIT_ORDER
#define _STRUCT_HIGH_BIT_FIRST_
#else
#define SOFTWARE_LITTLE_BIT_ORDER
#define _STRUCT_LOW_BIT_FIRST_
#endif

/* A status that an application may ignore without a warning. */
static inline int32 CFEPY_6_Status(int32 status)
{
    return status;
}

#define CCSDS_TIME_SIZE     6
#define CCSDS_TLM           0
#define CCSDS_CMD           1
#define CCSDS_NO_SEC_HDR    0
#define CCSDS_HAS_SEC_HDR   1
#define NUM_CCSDS_APIDS     2048
#define NUM_CCSDS_PKT_TYPES 2
#define CCSDS_INIT_SEQ      0
#define CCSDS_INIT_SEQFLG   3
#define CCSDS_INIT_FC       0
#define CCSDS_INIT_CHECKSUM 0

typedef struct {
    uint8 StreamId[2], Sequence[2], Length[2];
} CCSDS_PriHdr_t;

/* cFE 6 has a number here, with another order of the two bytes on each kind of processor. */
typedef struct {
    union {
        uint16 Command;
        uint8 CodeAndChecksum[2];
    };
} CCSDS_CmdSecHdr_t;

typedef struct {
    uint8 Time[CCSDS_TIME_SIZE];
} CCSDS_TlmSecHdr_t;

#if CFEPY_CFE_6 == 65
typedef struct {
    CCSDS_PriHdr_t PriHdr;
    CCSDS_CmdSecHdr_t SecHdr;
} CCSDS_CmdPkt_t;

typedef struct {
    CCSDS_PriHdr_t PriHdr;
    CCSDS_TlmSecHdr_t SecHdr;
} CCSDS_TlmPkt_t;

typedef struct {
    CCSDS_PriHdr_t Pri;
    CCSDS_CmdSecHdr_t Sec;
} CFE_SB_CmdHdr_t;

typedef struct {
    CCSDS_PriHdr_t Pri;
    CCSDS_TlmSecHdr_t Sec;
} CFE_SB_TlmHdr_t;

typedef union {
    CCSDS_PriHdr_t Hdr;
    uint32 Dword;
    uint8 Byte[sizeof(CCSDS_PriHdr_t)];
} CFE_SB_Msg_t;
#else
typedef struct {
    CCSDS_PriHdr_t Hdr;
} CFEPY_6_SpacePacket_t;
#define CCSDS_SpacePacket_t CFEPY_6_SpacePacket_t

typedef struct {
    CCSDS_SpacePacket_t SpacePacket;
    CCSDS_CmdSecHdr_t Sec;
} CCSDS_CommandPacket_t;

typedef struct {
    CCSDS_SpacePacket_t SpacePacket;
    CCSDS_TlmSecHdr_t Sec;
} CCSDS_TelemetryPacket_t;

typedef CCSDS_CommandPacket_t CCSDS_CmdPkt_t, CFE_SB_CmdHdr_t;
typedef CCSDS_TelemetryPacket_t CCSDS_TlmPkt_t, CFE_SB_TlmHdr_t;

typedef union {
    CCSDS_PriHdr_t Hdr;
    CCSDS_SpacePacket_t SpacePacket;
    uint32 Dword;
    uint8 Byte[sizeof(CCSDS_PriHdr_t)];
} CFE_SB_Msg_t;
#endif

#define CFE_SB_CMD_HDR_SIZE sizeof(CFE_SB_CmdHdr_t)
#define CFE_SB_TLM_HDR_SIZE sizeof(CFE_SB_TlmHdr_t)

/* ---- the primary header, bit by bit ---- */
#define CCSDS_RD_BITS(word, mask, shift) (((word) & (mask)) >> (shift))
#define CCSDS_WR_BITS(word, mask, shift, value) \
    ((word) = (uint16)(((word) & ~(mask)) | (((value) & ((mask) >> (shift))) << (shift))))
#define CFEPY_6_BIG(two)             (((two)[0] << 8) + (two)[1])
#define CFEPY_6_WRITE_BIG(two, value) ((two)[0] = (uint8)((value) >> 8), (two)[1] = (uint8)((value)&0xFF))
#define CFEPY_6_MIX(byte, kept, value) ((byte) = (uint8)(((byte) & (kept)) | ((value) & (uint8)~(kept))))
#define CCSDS_RD_SID(header)            CFEPY_6_BIG((header).StreamId)
#define CCSDS_WR_SID(header, value)     CFEPY_6_WRITE_BIG((header).StreamId, value)
#define CCSDS_RD_APID(header)           (CCSDS_RD_SID(header) & 0x07FF)
#define CCSDS_WR_APID(header, value) \
    (CFEPY_6_MIX((header).StreamId[0], 0xF8, (value) >> 8), (header).StreamId[1] = (uint8)((value)&0xFF))
#define CCSDS_RD_SHDR(header)           (((header).StreamId[0] & 0x08) >> 3)
#define CCSDS_WR_SHDR(header, value)    CFEPY_6_MIX((header).StreamId[0], 0xF7, (value) << 3)
#define CCSDS_RD_TYPE(header)           (((header).StreamId[0] & 0x10) >> 4)
#define CCSDS_WR_TYPE(header, value)    CFEPY_6_MIX((header).StreamId[0], 0xEF, (value) << 4)
#define CCSDS_RD_VERS(header)           (((header).StreamId[0] & 0xE0) >> 5)
#define CCSDS_WR_VERS(header, value)    CFEPY_6_MIX((header).StreamId[0], 0x1F, (value) << 5)
#define CCSDS_RD_SEQ(header)            (CFEPY_6_BIG((header).Sequence) & 0x3FFF)
#define CCSDS_WR_SEQ(header, value) \
    (CFEPY_6_MIX((header).Sequence[0], 0xC0, (value) >> 8), (header).Sequence[1] = (uint8)((value)&0xFF))
#define CCSDS_RD_SEQFLG(header)         (((header).Sequence[0] & 0xC0) >> 6)
#define CCSDS_WR_SEQFLG(header, value)  CFEPY_6_MIX((header).Sequence[0], 0x3F, (value) << 6)
#define CCSDS_RD_LEN(header)            (CFEPY_6_BIG((header).Length) + 7)
#define CCSDS_WR_LEN(header, value)     CFEPY_6_WRITE_BIG((header).Length, (value)-7)
#define CCSDS_INC_SEQ(header)           CCSDS_WR_SEQ(header, CCSDS_RD_SEQ(header) + 1)
#define CCSDS_CLR_PRI_HDR(header)                                                     \
    (CFEPY_6_WRITE_BIG((header).StreamId, 0), (header).Sequence[0] = CCSDS_INIT_SEQFLG << 6, \
     (header).Sequence[1] = 0, CFEPY_6_WRITE_BIG((header).Length, 0))
#define CCSDS_SID_APID(id) CCSDS_RD_BITS(id, 0x07FF, 0)
#define CCSDS_SID_SHDR(id) CCSDS_RD_BITS(id, 0x0800, 11)
#define CCSDS_SID_TYPE(id) CCSDS_RD_BITS(id, 0x1000, 12)
#define CCSDS_SID_VERS(id) CCSDS_RD_BITS(id, 0xE000, 13)

/* ---- secondary headers ---- */
#define CCSDS_RD_FC(second)              ((second).CodeAndChecksum[0] & 0x7F)
#define CCSDS_WR_FC(second, value)       CFEPY_6_MIX((second).CodeAndChecksum[0], 0x80, value)
#define CCSDS_RD_CHECKSUM(second)        ((second).CodeAndChecksum[1])
#define CCSDS_WR_CHECKSUM(second, value) ((second).CodeAndChecksum[1] = (uint8)((value)&0xFF))
#define CCSDS_CLR_CMDSEC_HDR(second)     ((second).Command = 0)
#define CCSDS_RD_SEC_HDR_SEC(second)                                                                \
    ((uint32)(second).Time[0] << 24 | (uint32)(second).Time[1] << 16 | (uint32)(second).Time[2] << 8 | \
     (uint32)(second).Time[3])
#define CCSDS_WR_SEC_HDR_SEC(second, value) \
    (CFEPY_6_WRITE_BIG((second).Time, (value) >> 16), CFEPY_6_WRITE_BIG((second).Time + 2, value))
#define CCSDS_RD_SEC_HDR_SUBSEC(second)        ((uint32)CFEPY_6_BIG((second).Time + 4))
#define CCSDS_WR_SEC_HDR_SUBSEC(second, value) CFEPY_6_WRITE_BIG((second).Time + 4, value)
#define CCSDS_CLR_TLMSEC_HDR(second) (CCSDS_WR_SEC_HDR_SEC(second, 0), CCSDS_WR_SEC_HDR_SUBSEC(second, 0))

#endif
