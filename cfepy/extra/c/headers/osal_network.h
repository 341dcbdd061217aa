/* OSAL: sockets, and waiting for several streams. */
#ifndef CFEPY_OSAL_NETWORK_H
#define CFEPY_OSAL_NETWORK_H

#include "osal_objects.h"

CFEPY_C_BEGIN

typedef enum { OS_SocketDomain_INVALID, OS_SocketDomain_INET, OS_SocketDomain_INET6, OS_SocketDomain_MAX } OS_SocketDomain_t;
typedef enum { OS_SocketType_INVALID, OS_SocketType_DATAGRAM, OS_SocketType_STREAM, OS_SocketType_MAX } OS_SocketType_t;

typedef enum {
    OS_SocketShutdownMode_NONE = 0, OS_SocketShutdownMode_SHUT_READ = 1, OS_SocketShutdownMode_SHUT_WRITE = 2,
    OS_SocketShutdownMode_SHUT_READWRITE = 3
} OS_SocketShutdownMode_t;

typedef union {
    uint8 Buffer[28];
    uint32 AlignU32;
    void *AlignPtr;
} OS_SockAddrData_t;

typedef struct {
    size_t ActualLength;
    OS_SockAddrData_t AddrData;
} OS_SockAddr_t;

typedef struct {
    char name[OS_MAX_API_NAME];
    osal_id_t creator;
} OS_socket_prop_t;

typedef enum OS_socket_option {
    OS_socket_option_UNDEFINED, OS_socket_option_IP_DSCP, OS_socket_option_MAX
} OS_socket_option_t;

typedef union OS_socket_optval {
    int32 IntVal;
} OS_socket_optval_t;

int32 OS_SocketAccept(osal_id_t sock_id, osal_id_t *connsock_id, OS_SockAddr_t *Addr, int32 timeout);
int32 OS_SocketAcceptAbs(osal_id_t sock_id, osal_id_t *connsock_id, OS_SockAddr_t *Addr, OS_time_t abs_timeout);
int32 OS_SocketAddrFromString(OS_SockAddr_t *Addr, const char *string);
int32 OS_SocketAddrGetPort(uint16 *PortNum, const OS_SockAddr_t *Addr);
int32 OS_SocketAddrInit(OS_SockAddr_t *Addr, OS_SocketDomain_t Domain);
int32 OS_SocketAddrSetPort(OS_SockAddr_t *Addr, uint16 PortNum);
int32 OS_SocketAddrToString(char *buffer, size_t buflen, const OS_SockAddr_t *Addr);
int32 OS_SocketBind(osal_id_t sock_id, const OS_SockAddr_t *Addr);
int32 OS_SocketBindAddress(osal_id_t sock_id, const OS_SockAddr_t *Addr);
int32 OS_SocketConnect(osal_id_t sock_id, const OS_SockAddr_t *Addr, int32 timeout);
int32 OS_SocketConnectAbs(osal_id_t sock_id, const OS_SockAddr_t *Addr, OS_time_t abs_timeout);
int32 OS_SocketGetIdByName(osal_id_t *sock_id, const char *sock_name);
int32 OS_SocketGetInfo(osal_id_t sock_id, OS_socket_prop_t *sock_prop);
int32 OS_SocketGetOption(osal_id_t sock_id, OS_socket_option_t opt_id, OS_socket_optval_t *optval);
int32 OS_SocketListen(osal_id_t sock_id);
int32 OS_SocketOpen(osal_id_t *sock_id, OS_SocketDomain_t Domain, OS_SocketType_t Type);
int32 OS_SocketRecvFrom(osal_id_t sock_id, void *buffer, size_t buflen, OS_SockAddr_t *RemoteAddr, int32 timeout);
int32 OS_SocketRecvFromAbs(osal_id_t sock_id, void *buffer, size_t buflen, OS_SockAddr_t *RemoteAddr,
    OS_time_t abs_timeout);
int32 OS_SocketSendTo(osal_id_t sock_id, const void *buffer, size_t buflen, const OS_SockAddr_t *RemoteAddr);
int32 OS_SocketSetOption(osal_id_t sock_id, OS_socket_option_t opt_id, const OS_socket_optval_t *optval);
int32 OS_SocketShutdown(osal_id_t sock_id, OS_SocketShutdownMode_t Mode);
int32 OS_NetworkGetHostName(char *host_name, size_t name_len);
int32 OS_NetworkGetID(void);

typedef struct {
    uint8 object_ids[(50 + 7) / 8];
} OS_FdSet;

typedef enum {
    OS_STREAM_STATE_BOUND = 0x01, OS_STREAM_STATE_CONNECTED = 0x02, OS_STREAM_STATE_READABLE = 0x04,
    OS_STREAM_STATE_WRITABLE = 0x08, OS_STREAM_STATE_LISTENING = 0x10
} OS_StreamState_t;

int32 OS_SelectFdAdd(OS_FdSet *Set, osal_id_t objid);
int32 OS_SelectFdClear(OS_FdSet *Set, osal_id_t objid);
bool OS_SelectFdIsSet(const OS_FdSet *Set, osal_id_t objid);
int32 OS_SelectFdZero(OS_FdSet *Set);
int32 OS_SelectMultiple(OS_FdSet *ReadSet, OS_FdSet *WriteSet, int32 msecs);
int32 OS_SelectMultipleAbs(OS_FdSet *ReadSet, OS_FdSet *WriteSet, OS_time_t abs_timeout);
int32 OS_SelectSingle(osal_id_t objid, uint32 *StateFlags, int32 msecs);
int32 OS_SelectSingleAbs(osal_id_t objid, uint32 *StateFlags, OS_time_t abs_timeout);

CFEPY_C_END

#endif
