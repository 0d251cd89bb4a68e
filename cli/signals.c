// SPDX-License-Identifier: Apache-2.0
// SIGINT, SIGTERM and SIGHUP ask for a clean stop; a second one leaves at once without temporaries.
#include "cli.h"
#include <signal.h>
#include <string.h>
#include <tsuya/base/file.h>
#include <tsuya/base/workers.h>
#include <unistd.h>

static void on_signal(int number)
{
    if (ty_cancel_requested())
    {
        ty_atomic_abort_all();
        _exit(128 + number);
    }
    ty_cancel_request(number);
}

void ty_signals_install(void)
{
    struct sigaction action;
    memset(&action, 0, sizeof action);
    action.sa_handler = on_signal;
    sigemptyset(&action.sa_mask);
    action.sa_flags = SA_RESTART;
    sigaction(SIGINT, &action, NULL);
    sigaction(SIGTERM, &action, NULL);
    struct sigaction inherited;
    if (sigaction(SIGHUP, NULL, &inherited) == 0 && inherited.sa_handler != SIG_IGN) // nohup stays nohup
    {
        sigaction(SIGHUP, &action, NULL);
    }
    // A closed pipe or a file-size limit is a write error with its own message, not a death.
    action.sa_handler = SIG_IGN;
    sigaction(SIGPIPE, &action, NULL);
    sigaction(SIGXFSZ, &action, NULL);
}
