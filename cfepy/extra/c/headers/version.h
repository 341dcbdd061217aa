/* The release of cFE that these headers are for, and swapped integers. */
#ifndef CFEPY_VERSION_H
#define CFEPY_VERSION_H

#define CFE_BUILD_BASELINE          "v7.0.0"
#define CFE_BUILD_CODENAME          "Draco"
#define CFE_BUILD_DEV_CYCLE         "v7.0.0"
#define CFE_BUILD_NUMBER            0
#define CFE_CFG_MAX_VERSION_STR_LEN 256
#define CFE_LAST_OFFICIAL           "v7.0.0"
#define CFE_MAJOR_VERSION           7
#define CFE_MINOR_VERSION           0
#define CFE_MISSION_REV             0x0
#define CFE_REVISION                0
#define CFE_SRC_VERSION             "v7.0.0+dev0"
#define CFE_STR_HELPER(x) #x
#define CFE_STR(x)        CFE_STR_HELPER(x)

#define CFE_MAKE_BIG16(n) ((((n) >> 8) & 0xFF) | (((n) & 0xFF) << 8))
#define CFE_MAKE_BIG32(n) \
    ((((n) >> 24) & 0xFF) | (((n) >> 8) & 0xFF00) | (((n) & 0xFF00) << 8) | (((n) & 0xFFu) << 24))

#endif
