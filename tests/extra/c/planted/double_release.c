/* A message buffer is given back after it was sent. */
void BUG_Main(void)
{
    uint32_t run = RUN;
    CFE_ES_RunLoop(&run);
    void *message = CFE_SB_AllocateMessageBuffer(64);
    CFE_MSG_Init(message, 0x0899, 64);
    CFE_SB_TransmitBuffer(message, true);
#ifndef MENDED
    CFE_SB_ReleaseMessageBuffer(message);
#endif
    CFE_ES_ExitApp(EXIT);
}
