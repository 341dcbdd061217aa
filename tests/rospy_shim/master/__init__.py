"""The master, the slave API and XML-RPC between nodes."""
