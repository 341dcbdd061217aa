/* The functions of libsocketcan, which hwlib's libcan.h needs on Linux. */
#ifndef CFEPY_SOCKETCAN_H
#define CFEPY_SOCKETCAN_H

#include <linux/can/netlink.h>

#ifdef __cplusplus
extern "C" {
#endif

int can_do_start(const char *name);
int can_do_stop(const char *name);
int can_do_restart(const char *name);
int can_get_state(const char *name, int *state);
int can_get_bittiming(const char *name, struct can_bittiming *timing);
int can_get_ctrlmode(const char *name, struct can_ctrlmode *mode);
int can_get_restart_ms(const char *name, __u32 *restart_ms);
int can_set_bitrate(const char *name, __u32 bitrate);
int can_set_bittiming(const char *name, struct can_bittiming *timing);
int can_set_ctrlmode(const char *name, struct can_ctrlmode *mode);
int can_set_restart_ms(const char *name, __u32 restart_ms);

#ifdef __cplusplus
}
#endif

#endif
