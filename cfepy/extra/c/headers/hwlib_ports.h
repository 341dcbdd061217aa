/* The ports and buses of NOS3's hwlib: structures and functions, on the devices of the mission. */
#ifndef CFEPY_HWLIB_PORTS_H
#define CFEPY_HWLIB_PORTS_H

#include <errno.h>
#include <fcntl.h>
#include <linux/can.h>
#include <linux/i2c-dev.h>
#include <linux/i2c.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/ioctl.h>
#include <termios.h>
#include <unistd.h>

#include "osal_objects.h"

CFEPY_C_BEGIN

/* ---- serial ports ---- */
#define UART_SUCCESS OS_SUCCESS
#define UART_ERROR   OS_ERROR
#define UART_FD_OPEN OS_ERR_FILE
#define PORT_CLOSED  0
#define PORT_OPEN    1
typedef enum { uart_access_flag_RDONLY, uart_access_flag_WRONLY, uart_access_flag_RDWR } uart_access_flag;

typedef struct {
    const char *deviceString;
    int32_t handle;
    uint8_t isOpen;
    uint32_t baud;
    uint8_t canonicalModeOn;
    struct termios options;
    uart_access_flag access_option;
} uart_info_t;

int32_t uart_init_port(uart_info_t *device);
int32_t uart_bytes_available(uart_info_t *device);
int32_t uart_flush(uart_info_t *device);
int32_t uart_read_port(uart_info_t *device, uint8_t data[], const uint32_t numBytes);
int32_t uart_write_port(uart_info_t *device, uint8_t data[], const uint32_t numBytes);
int32_t uart_close_port(uart_info_t *device);

/* ---- I2C ---- */
#define I2C_SUCCESS     OS_SUCCESS
#define I2C_ERROR       OS_ERROR
#define I2C_FD_OPEN_ERR OS_ERR_FILE
#define I2C_OPEN        0
#define I2C_CLOSED      1
#define I2C_MAX_BYTES   128
#define NUM_I2C         2

typedef struct {
    int32_t handle, addr;
    uint8_t isOpen;
    uint16_t speed;
} i2c_bus_info_t;

int32_t i2c_master_init(i2c_bus_info_t *device);
int32_t i2c_master_transaction(i2c_bus_info_t *device, uint8_t addr, void *txbuf, uint8_t txlen, void *rxbuf,
    uint8_t rxlen, uint16_t timeout);
int32_t i2c_read_transaction(i2c_bus_info_t *device, uint8_t addr, void *rxbuf, uint8_t rxlen, uint8_t timeout);
int32_t i2c_write_transaction(i2c_bus_info_t *device, uint8_t addr, void *txbuf, uint8_t txlen, uint8_t timeout);
int32_t i2c_multiple_transaction(i2c_bus_info_t *device, uint8_t addr, struct i2c_rdwr_ioctl_data *rdwr_data,
    uint16_t timeout);
int32_t i2c_master_close(i2c_bus_info_t *device);

/* ---- SPI ---- */
#define SPI_SUCCESS          OS_SUCCESS
#define SPI_ERROR            OS_ERROR
#define SPI_ERR_FILE_OPEN    (-2)
#define SPI_ERR_FILE_CLOSE   (-3)
#define SPI_ERR_FILE_HANDLE  (-4)
#define SPI_ERR_INVAL_MD     (-5)
#define SPI_ERR_WR_MODE      (-6)
#define SPI_ERR_RD_MODE      (-7)
#define SPI_ERR_WR_BPW       (-8)
#define SPI_ERR_RD_BPW       (-9)
#define SPI_ERR_WR_SD_HZ     (-10)
#define SPI_ERR_RD_SD_HZ     (-11)
#define SPI_ERR_IOC_MSG      (-12)
#define SPI_ERR_MUTEX_CREATE (-13)
#define SPI_DEVICE_CLOSED    0
#define SPI_DEVICE_OPEN      1
#define MAX_SPI_BUSES        3

typedef struct {
    const char *deviceString;
    int32_t handle;
    uint8_t bus, cs;
    uint32_t baudrate;
    uint8_t spi_mode, isOpen, bits_per_word;
} spi_info_t;

int32_t spi_init_dev(spi_info_t *device);
int32_t spi_set_mode(spi_info_t *device);
int32_t spi_get_mode(spi_info_t *device);
int32_t spi_write(spi_info_t *device, uint8_t data[], const uint32_t numBytes);
int32_t spi_read(spi_info_t *device, uint8_t data[], const uint32_t numBytes);
int32_t spi_transaction(spi_info_t *device, uint8_t *txBuff, uint8_t *rxBuffer, uint32_t length, uint16_t delay,
    uint8_t bits, uint8_t deselect);
int32_t spi_select_chip(spi_info_t *device);
int32_t spi_unselect_chip(spi_info_t *device);
int32_t spi_close_device(spi_info_t *device);

/* ---- pins ---- */
#define GPIO_SUCCESS     OS_SUCCESS
#define GPIO_ERROR       OS_ERROR
#define GPIO_FD_OPEN_ERR OS_ERR_FILE
#define GPIO_WRITE_ERR   (-3)
#define GPIO_READ_ERR    (-4)
#define GPIO_INPUT       0
#define GPIO_OUTPUT      1
#define GPIO_CLOSED      0
#define GPIO_OPEN        1

typedef struct {
    uint32_t pin;
    int32_t handle;
    uint8_t direction, isOpen;
} gpio_info_t;

int32_t gpio_init(gpio_info_t *device);
int32_t gpio_read(gpio_info_t *device, uint8_t *value);
int32_t gpio_write(gpio_info_t *device, uint8_t value);
int32_t gpio_close(gpio_info_t *device);

/* ---- CAN ---- */
#define CAN_SUCCESS          OS_SUCCESS
#define CAN_ERROR            OS_ERROR
#define CAN_UP_ERR           (-2)
#define CAN_DOWN_ERR         (-3)
#define CAN_SET_MODES_ERR    (-4)
#define CAN_SET_BITRATE_ERR  (-5)
#define CAN_SOCK_OPEN_ERR    (-6)
#define CAN_SOCK_FLAGSET_ERR (-7)
#define CAN_SOCK_BIND_ERR    (-8)
#define CAN_WRITE_ERR        (-9)
#define CAN_READ_ERR         (-10)
#define CAN_READ_TIMEOUT_ERR (-11)
#define CAN_SOCK_SETOPT_ERR  (-12)
#define CAN_INTERFACE_DOWN   0
#define CAN_INTERFACE_UP     1
#define CAN_MASTER           0
#define CAN_SLAVE            1

typedef struct {
    const char *handle;
    uint8_t isUp;
    bool loopback, listenOnly, tripleSampling, oneShot, berrReporting, fd, presumeAck;
    uint32_t bitrate;
} can_info_t;

int32_t can_init_dev(can_info_t *device);
int32_t can_set_modes(can_info_t *device);
int32_t can_write(can_info_t *device, uint32_t can_id, uint8_t *buf, const uint32_t length);
int32_t can_blocking_read(can_info_t *device, struct can_frame *readFrame, const uint32_t length);
int32_t can_nonblocking_read(can_info_t *device, struct can_frame *readFrame, const uint32_t length,
    uint32_t second_timeout, uint32_t microsecond_timeout);
int32_t can_master_transaction(can_info_t *device, uint32_t can_id, uint8_t *txbuf, const uint32_t txlen,
    uint8_t *rxbuf, const uint32_t rxlen, uint32_t second_timeout, uint32_t microsecond_timeout);
int32_t can_close_device(can_info_t *device);

CFEPY_C_END

#endif
