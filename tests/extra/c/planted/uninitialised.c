/* A field of a packet is never filled in. */
struct packet { uint8_t header[16]; uint32_t count, mode; };

void BUG_Main(void)
{
    uint32_t pipe, run = RUN;
    CFE_ES_RunLoop(&run);
    struct packet *packet = malloc(sizeof *packet);
    CFE_MSG_Init(packet, 0x0899, 16);
    CFE_MSG_SetSize(packet, sizeof *packet);
    packet->count = 7;
#ifdef MENDED
    packet->mode = 0;
#endif
    CFE_SB_CreatePipe(&pipe, 5, "BUG");
    CFE_SB_Subscribe(0x0899, pipe);
    CFE_SB_TransmitMsg(packet, true);
    CFE_ES_ExitApp(EXIT);
}
