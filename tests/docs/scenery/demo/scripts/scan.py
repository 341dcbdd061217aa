#!/usr/bin/env python3
"""Tells the lines of a file."""

import argparse

import rospy

parser = argparse.ArgumentParser()
parser.add_argument("--verbose", action="store_true")
parser.add_argument("file")
options = parser.parse_args(rospy.myargv()[1:])
rospy.init_node("scan")
with open(options.file, encoding="utf-8") as file:
    rospy.loginfo("%d lines%s", len(file.readlines()), ", verbose" if options.verbose else "")
