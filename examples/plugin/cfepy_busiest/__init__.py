"""An add-on of cfepy: which topics and packets were sent most."""

from cfepy.plugins import Plugin

PLUGIN = Plugin(
    name="busiest",
    package="cfepy_busiest",
    commands=("busiest",),
    title="Traffic",
    parser=".command",
    hooks={"report_tables": ".ranking:tables"},
)
