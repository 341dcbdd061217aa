/* An application with devices as Linux's device files. */
#include "cfe.h"

#include <errno.h>
#include <fcntl.h>
#include <linux/i2c-dev.h>
#include <linux/i2c.h>
#include <linux/spi/spidev.h>
#include <sys/ioctl.h>
#include <termios.h>
#include <unistd.h>

static void Say(const char *What, long Value)
{
    CFE_EVS_SendEvent(1, CFE_EVS_EventType_INFORMATION, "%s %ld", What, Value);
}

static void Serial(void)
{
    struct termios Options;
    char Data[16];
    int Waiting = -1, Fd = open("/dev/ttyS1", O_RDWR | O_NOCTTY);

    Say("open", Fd >= 0);
    Say("get", tcgetattr(Fd, &Options));
    Say("VMIN", Options.c_cc[VMIN]);
    cfmakeraw(&Options);
    cfsetispeed(&Options, B9600);
    Options.c_cc[VMIN] = 0;
    Options.c_cc[VTIME] = 2;
    Say("speed", cfgetispeed(&Options) == B9600);
    Say("set", tcsetattr(Fd, TCSANOW, &Options));
    Say("write", write(Fd, "ping", 4));
    Say("ioctl", ioctl(Fd, FIONREAD, &Waiting));
    Say("waiting", Waiting);
    Say("read", read(Fd, Data, sizeof(Data)));
    Say("first", Data[0]);
    Say("timeout", read(Fd, Data, sizeof(Data)));
    fcntl(Fd, F_SETFL, O_NONBLOCK);
    Say("nonblocking", read(Fd, Data, sizeof(Data)));
    Say("EAGAIN", errno == EAGAIN);
    Say("close", close(Fd));
    Say("absent", open("/dev/ttyS9", O_RDWR));
    Say("ENOENT", errno == ENOENT);
    Say("bad", write(-1, "x", 1));
    Say("EBADF", errno == EBADF);
    Say("bad close", close(-1));
}

static void Buses(void)
{
    uint8 Register = 0x0F, Data[3] = {0}, Mode = 3, Got = 0;
    struct i2c_msg Messages[2] = {{.addr = 0x1E, .len = 1, .buf = &Register},
                                  {.addr = 0x1E, .flags = I2C_M_RD, .len = 3, .buf = Data}};
    struct i2c_rdwr_ioctl_data Both = {Messages, 2};
    struct spi_ioc_transfer Transfer = {.tx_buf = (cpuaddr)Data, .rx_buf = (cpuaddr)Data, .len = 3};
    int Fd = open("/dev/i2c-1", O_RDWR), Spi = open("/dev/spidev0.0", O_RDWR);

    Say("no address", write(Fd, &Register, 1));
    Say("slave", ioctl(Fd, I2C_SLAVE, 0x1E));
    Say("i2c write", write(Fd, &Register, 1));
    Say("i2c read", read(Fd, Data, 3));
    Say("i2c data", Data[0] << 16 | Data[1] << 8 | Data[2]);
    Say("both", ioctl(Fd, I2C_RDWR, &Both));
    Messages[0].addr = 0x20;
    Say("none", ioctl(Fd, I2C_RDWR, &Both));
    Say("EREMOTEIO", errno == EREMOTEIO);
    Say("mode", ioctl(Spi, SPI_IOC_WR_MODE, &Mode));
    ioctl(Spi, SPI_IOC_RD_MODE, &Got);
    Say("got", Got);
    Say("spi", ioctl(Spi, SPI_IOC_MESSAGE(1), &Transfer));
    Say("spi data", Data[0] << 16 | Data[1] << 8 | Data[2]);
    Say("ENOTTY", ioctl(Spi, 0x1234, 0));
}

void FILES_Main(void)
{
    CFE_EVS_Register(NULL, 0, CFE_EVS_EventFilter_BINARY);
    Serial();
    Buses();
    while (CFE_ES_RunLoop(NULL)) {
        OS_TaskDelay(1000);
    }
}
