/* The length in a header is written as the processor has it, not as CCSDS wants it. */
void BUG_Main(void)
{
    static uint8_t message[200];
    uint32_t run = RUN;
    uint16_t length = sizeof message - 7;
    CFE_EVS_Register(NULL, 0, 0); /* otherwise its mistakes have no events */
    CFE_ES_RunLoop(&run);
    CFE_MSG_Init(message, 0x0899, sizeof message);
#ifdef MENDED
    length = __builtin_bswap16(length);
#endif
    memcpy(message + 4, &length, 2);
    CFE_SB_TransmitMsg(message, true);
    CFE_ES_ExitApp(EXIT);
}
