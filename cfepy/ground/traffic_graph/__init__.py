"""The graph of a mission: senders, messages, and the pipes of receivers, and its presentation.

Code that collects the findings of a flight (`model`) or presents them as text, for graphviz or as a drawing belongs
here. The flight itself, and the number of lost messages, belong to the report of a run.
"""
