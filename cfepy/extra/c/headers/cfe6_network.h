/* cFE 6: network_includes.h, the host's headers of sockets. Calls of the host's functions are faults. */
#ifndef CFEPY_CFE6_NETWORK_H
#define CFEPY_CFE6_NETWORK_H

#include <arpa/inet.h>
#include <fcntl.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <sys/socket.h>
#include <sys/types.h>
#include <unistd.h>
#define _HAVE_FCNTL_

#endif
