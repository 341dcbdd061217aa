/* An application with a device of each kind, through hwlib's calls. */
#include "cfe.h"
#include "hwlib.h"
#include <libsocketcan.h>

static void Say(const char *What, int32 Status, const uint8 *Data, int Count)
{
    char Text[64] = "";
    int At = 0;

    while (At < Count && At < 20) {
        snprintf(Text + 2 * At, sizeof(Text) - 2 * At, "%02x", Data[At]);
        At++;
    }
    CFE_EVS_SendEvent(1, CFE_EVS_EventType_INFORMATION, "%s %d %s", What, (int)Status, Text);
}

static void Serial(const char *Name)
{
    uart_info_t Uart = {.deviceString = Name, .baud = 115200, .access_option = uart_access_flag_RDWR};
    uint8 Data[16] = "ping";
    int32 Status = uart_init_port(&Uart);

    Say("uart init", Status, &Uart.isOpen, 1);
    Say("uart write", uart_write_port(&Uart, Data, 4), NULL, 0);
    Say("uart waiting", uart_bytes_available(&Uart), NULL, 0);
    Status = uart_read_port(&Uart, Data, sizeof(Data));
    Say("uart read", Status, Data, Status);
    Say("uart nothing", uart_read_port(&Uart, Data, sizeof(Data)), NULL, 0);
    Say("uart close", uart_close_port(&Uart), &Uart.isOpen, 1);
}

static void Buses(void)
{
    i2c_bus_info_t Bus = {.handle = 1};
    spi_info_t Spi = {.deviceString = "/dev/spidev0.0", .bus = 0, .spi_mode = 1};
    gpio_info_t Pin = {.pin = 24, .direction = GPIO_OUTPUT};
    can_info_t Can = {.handle = "can0", .bitrate = 500000};
    struct can_frame Frame;
    uint8 Register = 0x0F, Data[4] = {1, 2, 3, 4};
    int32 Status;

    Say("i2c init", i2c_master_init(&Bus), NULL, 0);
    Say("i2c read", i2c_master_transaction(&Bus, 0x1E, &Register, 1, Data, 3, 10), Data, 3);
    Say("i2c absent", i2c_read_transaction(&Bus, 0x20, Data, 1, 10), NULL, 0);
    Say("spi init", spi_init_dev(&Spi), NULL, 0);
    Say("spi", spi_transaction(&Spi, Data, Data, 4, 0, 8, 0), Data, 4);
    Say("gpio init", gpio_init(&Pin), NULL, 0);
    Say("gpio write", gpio_write(&Pin, 1), NULL, 0);
    Say("gpio read", gpio_read(&Pin, Data), Data, 1);
    Say("can bitrate", can_set_bitrate("can0", 500000), NULL, 0);
    Say("can start", can_do_start("can0"), NULL, 0);
    Say("can absent", can_do_start("can7"), NULL, 0);
    Say("can init", can_init_dev(&Can), NULL, 0);
    Say("can write", can_write(&Can, 0x123, Data, 2), NULL, 0);
    Status = can_nonblocking_read(&Can, &Frame, sizeof(Frame), 0, 100000);
    Say("can read", Status, Frame.data, Frame.can_dlc);
    Say("can id", Frame.can_id, NULL, 0);
    Say("can late", can_nonblocking_read(&Can, &Frame, sizeof(Frame), 0, 100000), NULL, 0);
}

/* The devices are there, and the application has not opened them, or has closed them. */
static void Closed(int IsAfter)
{
    uart_info_t Uart = {.deviceString = "/dev/ttyS1", .baud = 115200};
    i2c_bus_info_t Bus = {.handle = 1};
    spi_info_t Spi = {.deviceString = "/dev/spidev0.0", .spi_mode = 1};
    gpio_info_t Pin = {.pin = 24};
    can_info_t Can = {.handle = "can0"};
    uint8 Data[4] = {1, 2, 3, 4};

    if (IsAfter) {
        uart_init_port(&Uart), spi_init_dev(&Spi), gpio_init(&Pin), can_init_dev(&Can);
        uart_close_port(&Uart), i2c_master_close(&Bus), spi_close_device(&Spi), gpio_close(&Pin), can_close_device(&Can);
    }
    Say("closed uart", uart_write_port(&Uart, Data, 4), NULL, 0);
    Say("closed uart", uart_read_port(&Uart, Data, 4), NULL, 0);
    Say("closed i2c", i2c_write_transaction(&Bus, 0x1E, Data, 1, 10), NULL, 0);
    Say("closed spi", spi_transaction(&Spi, Data, Data, 4, 0, 8, 0), NULL, 0);
    Say("closed gpio", gpio_write(&Pin, 1), NULL, 0);
    Say("closed gpio", gpio_read(&Pin, Data), NULL, 0);
    Say("closed can", can_write(&Can, 0x123, Data, 2), NULL, 0);
}

void SENSOR_Main(void)
{
    CFE_EVS_Register(NULL, 0, CFE_EVS_EventFilter_BINARY);
    Closed(0);
    Serial("/dev/ttyS1");
    Serial("/dev/ttyS9");
    Buses();
    OS_TaskDelay(2000); /* more than 32 events at once are squelched */
    Closed(1);
    while (CFE_ES_RunLoop(NULL)) {
        OS_TaskDelay(1000);
    }
}
