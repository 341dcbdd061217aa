$DEMO_IDS = {
  "ES" => Ids.new(
    base_stream_id: 0x1806,
    packet_names: [
      "ES_CMD_NOOP",
      "ES_CMD_RESTART",
    ]
  ),
}
