/* Ids of the events of CFE_EVS. */
#ifndef CFEPY_EVS_EVENTS_H
#define CFEPY_EVS_EVENTS_H

#define CFE_EVS_NOOP_EID                 0
#define CFE_EVS_STARTUP_EID              1
#define CFE_EVS_ERR_WRLOGFILE_EID        2
#define CFE_EVS_ERR_CRLOGFILE_EID        3
#define CFE_EVS_ERR_MSGID_EID            5
#define CFE_EVS_ERR_EVTIDNOREGS_EID      6
#define CFE_EVS_ERR_APPNOREGS_EID        7
#define CFE_EVS_ERR_ILLAPPIDRANGE_EID    8
#define CFE_EVS_ERR_NOAPPIDFOUND_EID     9
#define CFE_EVS_ERR_ILLEGALFMTMOD_EID    10
#define CFE_EVS_ERR_MAXREGSFILTER_EID    11
#define CFE_EVS_ERR_WRDATFILE_EID        12
#define CFE_EVS_ERR_CRDATFILE_EID        13
#define CFE_EVS_WRITE_HEADER_ERR_EID     14
#define CFE_EVS_ERR_CC_EID               15
#define CFE_EVS_RSTCNT_EID               16
#define CFE_EVS_SETFILTERMSK_EID         17
#define CFE_EVS_ENAPORT_EID              18
#define CFE_EVS_DISPORT_EID              19
#define CFE_EVS_ENAEVTTYPE_EID           20
#define CFE_EVS_DISEVTTYPE_EID           21
#define CFE_EVS_SETEVTFMTMOD_EID         22
#define CFE_EVS_ENAAPPEVTTYPE_EID        23
#define CFE_EVS_DISAPPENTTYPE_EID        24
#define CFE_EVS_ENAAPPEVT_EID            25
#define CFE_EVS_DISAPPEVT_EID            26
#define CFE_EVS_RSTEVTCNT_EID            27
#define CFE_EVS_RSTFILTER_EID            28
#define CFE_EVS_RSTALLFILTER_EID         29
#define CFE_EVS_ADDFILTER_EID            30
#define CFE_EVS_DELFILTER_EID            31
#define CFE_EVS_WRDAT_EID                32
#define CFE_EVS_WRLOG_EID                33
#define CFE_EVS_EVT_FILTERED_EID         37
#define CFE_EVS_LOGMODE_EID              38
#define CFE_EVS_ERR_LOGMODE_EID          39
#define CFE_EVS_ERR_INVALID_BITMASK_EID  40
#define CFE_EVS_ERR_UNREGISTERED_EVS_APP 41
#define CFE_EVS_FILTER_MAX_EID           42
#define CFE_EVS_LEN_ERR_EID              43
#define CFE_EVS_SQUELCHED_ERR_EID        44

#endif
