"""What a run looks like: a trace for Perfetto, a page for a browser.

It looks on at a mission through `cfepy.mission.observer`, and may import cfepy.mission and below.
"""
