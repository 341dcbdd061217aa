/* cFE 6: the names of cFE 6.0 to 6.8 for sources that are compiled against cFE 7, given with -include.
 * CFEPY_CFE_6 is 65, 67 or 68. All headers of cFE 7 come first, under their guards; then macros give names another meaning.
 * Most are macros with arguments, so that faults and traces have the line of the application. */
#ifndef CFEPY_CFE6_H
#define CFEPY_CFE6_H

#if CFEPY_CFE_6 != 65 && CFEPY_CFE_6 != 67 && CFEPY_CFE_6 != 68
#error "CFEPY_CFE_6 must be 65, 67 or 68; cfepy build --cfe 6.5, --cfe 6.7 or --cfe 6.8 sets it"
#endif
#ifdef MESSAGE_FORMAT_IS_CCSDS_VER_2
#error "MESSAGE_FORMAT_IS_CCSDS_VER_2 has extended headers, which cFE 7 has only in a build of its own; leave it out"
#endif
#define MESSAGE_FORMAT_IS_CCSDS

#include "config.h"
#include "config_ids.h"
#include "es.h"
#include "es_events.h"
#include "es_messages.h"
#include "evs.h"
#include "evs_events.h"
#include "evs_messages.h"
#include "fs.h"
#include "msg.h"
#include "msgids.h"
#include "osal_files.h"
#include "osal_network.h"
#include "osal_objects.h"
#include "perfids.h"
#include "psp.h"
#include "sb.h"
#include "sb_events.h"
#include "sb_messages.h"
#include "status.h"
#include "tbl.h"
#include "tbl_events.h"
#include "tbl_messages.h"
#include "time.h"
#include "time_events.h"
#include "time_messages.h"
#include "version.h"

#if CFEPY_CFE_6 == 68
#include "cfe6_between.h"
#else
#include "cfe6_config.h"
#include "cfe6_headers.h"
#include "cfe6_messages.h"
#include "cfe6_osal.h"
#endif
#include "cfe6_services.h"

#endif
