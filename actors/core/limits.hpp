#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>

/// All limits and timeouts of a node, by subject, each with its reason. Who
/// waits for another one waits longer than that one does, so that the answer
/// says what went wrong; the `static_assert`s hold that.
///
/// It includes nothing of ours, so that the edge may include it too. What
/// belongs to a format, a protocol of others or an algorithm stands there.
namespace roscell::limits {

using std::chrono::milliseconds;
using std::chrono::minutes;
using std::chrono::seconds;

constexpr size_t kib = 1024;
constexpr size_t mib = 1024 * kib;

/// How long a silent peer counts as alive. Both sides use the same numbers.
namespace lease {

/// An outage of less than `span - heartbeat_period` is never noticed.
constexpr milliseconds span{8000};
/// A member's heartbeats are this far apart.
constexpr milliseconds heartbeat_period{4000};
/// After a miss the peer is asked again this often,
constexpr milliseconds probe_interval{250};
/// and this often in the last seconds of the lease: 16 questions in all would
/// lose a living member every 14,000 hours where each direction loses 20 %,
/// 24 questions lose it every 50 million hours.
constexpr milliseconds urgent_probe_interval{125};
constexpr milliseconds urgent_span{2000};

static_assert(heartbeat_period + probe_interval < span - urgent_span);

} // namespace lease

/// Pauses between attempts of a node to join, of a coordinator to reach a peer
/// and the like, each twice the one before.
namespace retry {

constexpr milliseconds first{250};
constexpr milliseconds longest{30'000};

} // namespace retry

/// Actors of one node, and the coordinator's answers from what it knows.
namespace local {

/// For a part that only looks at its own state, or at the host.
constexpr seconds part{5};
/// For what may ask one part after another.
constexpr seconds answer{10};

static_assert(part < answer);

} // namespace local

/// The node's database.
namespace store {

/// For one record of the coordinator. What waits for it has `local::answer`.
constexpr seconds write{5};

/// Records that wait in memory for room on the disk; who brings one more is
/// refused. Some for each instance, and two for the node itself.
constexpr size_t waiting = 1024;

static_assert(write < local::answer);

} // namespace store

/// Reading what a node has and uses.
namespace resource {

/// What a coordinator waits for its members' metrics: those that come later
/// are missing, since one silent node must not hold up a task.
constexpr seconds collection{3};
/// What a scraper of metrics waits for them: those that come later are in its
/// next scrape.
constexpr milliseconds scrape_collection{5};
/// How often a node is asked in one collection, at most.
constexpr int rounds = 3;
/// CPU use is a rate over at least the first and at most the second.
constexpr seconds least_sample_age{1};
constexpr seconds most_sample_age{30};
/// Samples closer than this are one; so that many always span more than
/// `least_sample_age`.
constexpr milliseconds sample_distance{100};
constexpr size_t samples = 16;
/// A coordinator hears the heartbeats of many members; one sample serves for
/// all. A little shorter than the pause between the heartbeats of one member.
constexpr milliseconds mark_distance{3500};

static_assert(mark_distance < lease::heartbeat_period);
static_assert(sample_distance * samples > least_sample_age);
static_assert(collection < local::answer);
static_assert(scrape_collection < collection);

} // namespace resource

/// One skill instance, from intent to end.
namespace instance {

/// Live ones on a node. Each costs a shim and three descriptors.
constexpr size_t most = 256;
/// Ended ones whose rows and logs stay until their task is removed.
constexpr size_t most_ended = 32;

/// Rows that a coordinator remembers of what one node has told.
constexpr size_t reported = 1024;

static_assert(most + most_ended < reported);
/// Rows of older ones that stay until the coordinator keeps that they have
/// ended, or their task is removed: it must not take them for lost and start
/// them again. They are part of a registration, which is one frame.
constexpr size_t most_unacknowledged_bytes = 256 * kib;

/// An actor that dies more often than this will not do better next time.
constexpr int most_deaths = 5;
/// For one record on a slow disk, and for reading the end of a log.
constexpr seconds disk{10};
/// A container engine may have to fetch a base image of some GiB.
constexpr minutes build{10};
/// From the runtime's "start" to its answer.
constexpr seconds start{30};
/// From the start of the program to READY=1; loading a model takes a while.
constexpr seconds ready{30};
/// All of it.
constexpr seconds deployment = build + start + ready + 2 * disk;
/// From the polite request to end to force.
constexpr seconds stop_grace{5};
/// The longest that a runtime can be told to grant.
constexpr milliseconds most_stop_grace{60'000};
/// From one stage of force to the next, for processes.
constexpr seconds force_interval{2};
/// For an engine to kill what does not obey.
constexpr seconds force{10};
/// Beyond the grace; must exceed the runtime's stages of force.
constexpr seconds stop{15};
/// For what an instance left.
constexpr seconds cleaning{15};
/// All of it.
constexpr seconds removal = stop_grace + stop + cleaning + disk;

/// Silence after which a running skill is taken for hung.
constexpr seconds watchdog{10};

/// What skills are told of it. They say that they are alive twice in this time,
/// so after a lost word the next one still comes before they are judged.
constexpr seconds announced_watchdog{8};

/// An alarm that comes later than this tells of a pause of our own process.
constexpr seconds pause_tolerance{2};

/// For the first word of a skill after such a pause.
constexpr seconds pause_grace{5};

/// For the runtime to read a socket. One that does not answer in time says
/// nothing of the skill, and is asked again.
constexpr seconds hearing{10};

/// Most of the log's end that goes along with a failure.
constexpr size_t log_tail_bytes = 8 * kib;
/// Earlier ends that are kept of an instance, and of each of their logs so many
/// lines and bytes: they travel with every change of it.
constexpr size_t kept_ends = 5;
constexpr size_t end_lines = 5;
constexpr size_t end_log_bytes = kib;
/// Between two new starts in a row, whatever the policy says: each costs a
/// process and a write.
constexpr milliseconds least_pause{100};
/// Of them in a registration, which is one frame.
constexpr size_t registered_ends = 2;
/// Most of what is said of why it ended.
constexpr size_t reason_bytes = 2 * kib;
/// A program that talks to its NOTIFY_SOCKET without end causes 50 messages a
/// second at most: what comes in between is merged, or waits in its socket.
constexpr milliseconds status_pause{20};
/// For a shim to say that its program runs.
constexpr seconds shim{5};

static_assert(shim < start);
static_assert(announced_watchdog < watchdog
              && announced_watchdog / 2 < pause_grace);
static_assert(3 * force_interval < stop);
static_assert(force < stop);

} // namespace instance

/// Container engines and the images that are built for skills.
namespace engine {

/// For a call that takes an idle engine milliseconds.
constexpr seconds call{10};
/// For one that shows whether an engine is there.
constexpr seconds probe{2};
/// Creating a container copies nothing, but a loaded engine takes its time.
constexpr seconds create{20};
constexpr seconds start{20};
/// For an image's plan: hashing a folder, finding the libraries of programs.
constexpr seconds plan{60};
constexpr seconds linker{10};
/// For each of the packer's two steps: some GiB of checkpoints, a slow disk.
constexpr minutes pack_step{5};
constexpr minutes pack{11};
/// Shorter than the instance's limit, so that the log goes along.
constexpr minutes build{9};
/// A build says no more than once in this time how it gets on.
constexpr seconds build_status{1};
/// Lines of a build that are kept for the case that it fails, and their bytes.
constexpr size_t kept_build_lines = 40;
constexpr size_t build_line_bytes = 512;
/// A line of a build or an event is some hundred bytes.
constexpr size_t line_bytes = mib;
/// Longest body of an answer that is no stream.
constexpr size_t reply_bytes = 8 * mib;
constexpr size_t header_bytes = 64 * kib;
/// Longest text of an engine, or of a program it runs, that people get.
constexpr size_t status_bytes = 2 * kib;

static_assert(2 * pack_step < pack);
static_assert(build < instance::build);
static_assert(create + probe < instance::start);
static_assert(start < instance::start);

} // namespace engine

/// Two ends of a session. The node gives up its own parts `margin` before the
/// coordinator gives up the node, so that the coordinator hears why.
namespace session {

constexpr milliseconds margin{2000};
/// Largest frame, in and out.
constexpr size_t frame_bytes = mib;
/// Frames that wait for a slow peer; beyond it the session is closed.
constexpr size_t queue_bytes = 4 * mib;
/// Frames of the peer that wait for their handler; beyond it nothing is read,
/// and the peer feels it.
constexpr size_t undone_frames = 8;
/// From the first connection attempt to the last frame of the handshake.
constexpr milliseconds handshake{5000};
/// For frames that still wait and the closing handshake of WebSocket.
constexpr milliseconds close{1000};
/// What a listener still reads of a connection that it has refused.
constexpr milliseconds linger{1000};
/// How long sent bytes may stay unacknowledged before the connection is lost.
constexpr milliseconds unacknowledged = lease::span;
/// For the owner of a session to take a frame.
constexpr seconds owner{30};
/// For a session to another coordinator, or of a node that joins.
constexpr seconds open{10};
/// Requests that wait for their replies. No peer needs more at once.
constexpr size_t pending_calls = 256;
/// Ids of requests that are known, so that one delivered twice is done once.
constexpr size_t known_calls = 256;
/// Heartbeats whose times are known until they are answered: more than a lease
/// has.
constexpr size_t remembered_heartbeats = 64;
/// Larger answers are not kept: who asks again is told to ask anew.
constexpr size_t kept_answer_bytes = 16 * kib;
/// Of the specs that an answer to a registration carries; half a frame, since
/// JSON escapes some bytes.
constexpr size_t answered_starts_bytes = frame_bytes / 2;
/// A peer that sends more that cannot be read does not speak our language.
constexpr unsigned bad_frames = 3;
/// A measurement that has no CPU sample yet takes a second.
constexpr milliseconds resource_query{6000};
/// For what a node's instances say of themselves.
constexpr milliseconds metrics{4000};
/// One coordinator's word to another one.
constexpr milliseconds peer_answer{3000};

static_assert(handshake < open);
static_assert(pending_calls <= known_calls);
static_assert(kept_answer_bytes < frame_bytes);
static_assert(2 * instance::most_unacknowledged_bytes < frame_bytes);
static_assert(margin < peer_answer);
static_assert(margin < metrics);

} // namespace session

/// How a node becomes a member of a cell, and leaves it.
namespace membership {

/// From the session's start to the registration.
constexpr milliseconds registration_arrival{15'000};
/// From the registration to its answer. Shorter than a lease: a registry must
/// not show for longer a member that does not know that it is one.
constexpr milliseconds registration{5000};
/// What the coordinator has for it, so that the node hears the outcome.
constexpr milliseconds row{4000};
/// For a place: the coordinator that hands them out may be another one, and a
/// third one has to keep it.
constexpr milliseconds place{8000};
/// For a switch to be written down.
constexpr milliseconds switching{6000};
/// How long a node that leaves waits for the coordinator to know,
constexpr milliseconds departure{2000};
/// and the NODE for the node to have left.
constexpr seconds leaving{3};
/// From the signal to the process's end: systemd would wait 90 s before it uses
/// force.
constexpr seconds stopping{5};

static_assert(leaving < stopping);

/// Coordinators that were started together appear one after the other; asking
/// all of them at once for places would make the first ones full.
constexpr milliseconds gathering{200};
/// How long a discovery server is looked for before the next pause.
constexpr milliseconds search{5000};
/// After so much silence the address is looked at, to say what is wrong: the
/// answer is there well before 5 s are over.
constexpr milliseconds silence{1500};
/// For one port to answer the join diagnoser,
constexpr milliseconds probed_port{1500};
/// for all it has found out,
constexpr milliseconds probed{2500};
/// and for a host name to be looked up: resolvers try again after 5 s.
constexpr milliseconds naming{3000};
/// Names that are being looked up at a time: each has a thread, which a dead
/// name server holds for long.
constexpr size_t lookups = 8;
/// The same problem is told again after the first pause, then after pauses
/// each twice the one before.
constexpr seconds complaint_pause{60};
constexpr minutes longest_complaint_pause{30};
/// Different problems of one series that are told at once.
constexpr size_t complaints = 8;
/// A coordinator that has refused once is unlikely to change its mind soon.
constexpr milliseconds refusal_pause{30'000};
/// How long a name stays with a node that is silent.
constexpr milliseconds name_held = lease::span;

/// The same for one that is expected back: longer than the pause between two
/// of its attempts and the attempt itself.
constexpr milliseconds expected_name_held{45'000};

static_assert(retry::longest + search + registration < expected_name_held);
static_assert(probed_port < probed && silence + probed < search);
static_assert(naming < search);
static_assert(row < registration && registration < lease::span);
static_assert(2 * session::peer_answer < place);
static_assert(departure < leaving);

} // namespace membership

/// What anybody may announce on the public domain. Nobody who has not proved
/// that he is of the site costs more than this.
namespace unauthenticated_peers {

/// Participants that one node listens to.
constexpr size_t participants = 1024;

/// What is repeated is told again this often, as whoever listens may have had
/// no room for it.
constexpr seconds retelling{60};

/// Coordinators that are remembered; by a coordinator, and by a node that
/// wants a place.
constexpr size_t coordinators = 256;
constexpr size_t slot_arbiters = 64;

/// Nodes in no cell that are remembered.
constexpr size_t unassigned_nodes = 1024;
/// Of those that announce themselves no more, the last ones.
constexpr size_t silent_nodes = 64;

/// Connections that are being opened at a time: to coordinators, and to nodes
/// that are to prove where they stand.
constexpr size_t peer_calls = 6;
constexpr size_t proof_calls = 2;

/// One that failed keeps its slot this long, so that ever new addresses cost no
/// more than the slots in that time.
constexpr seconds slot_pause{1};

/// A nonce goes there, a proof comes back.
constexpr seconds proof{8};

static_assert(peer_calls + proof_calls <= 8);

} // namespace unauthenticated_peers

/// How cells form and are balanced.
namespace cell {

/// Rows of one cell, whatever their state. Each member has a discovery server
/// whose id is one byte, and the coordinator has one too; ids of coordinators
/// of other cells that it sees are avoided while there are others.
constexpr size_t rows = 250;
/// Nodes that are drained, those that are no rows any more with them.
constexpr size_t drains = 2 * rows;

static_assert(rows + 1 <= UINT8_MAX + 1, "each row has a server's id");

/// Time for a place's node to come: it has to find the server and open a
/// session.
constexpr seconds place{30};
/// For a node's REST answer to a registration switch, which another node's
/// HTTP client gives `registration_call` for.
constexpr milliseconds registration_call{5000};
constexpr seconds invitation{12};
/// For a node that said yes to arrive.
constexpr seconds arrival{25};
/// For a place that waits for an invited node.
constexpr seconds invited_place{40};

/// Until a coordinator that has just appeared has told its size; a node that
/// asks for a slot waits no longer for it.
constexpr milliseconds sizes{1500};
/// Places in other cells that are remembered, and those who wait for a node or
/// for the sizes.
constexpr size_t places = 4096;
constexpr size_t waiting = 1024;
/// After a change of the coordinators' sizes, until they are balanced.
constexpr seconds settling{2};

static_assert(registration_call < invitation);
static_assert(registration_call < unauthenticated_peers::proof);
static_assert(invitation + arrival < invited_place);

} // namespace cell

/// From the outside in: whoever asks for a task to run waits longest.
namespace task {

/// Searching an allocation while other searches wait.
constexpr seconds search{60};
/// What the search itself may take, for a live cell and for a plan on paper.
constexpr milliseconds allocation_budget{200};
constexpr milliseconds offline_allocation_budget{20'000};
/// What a search for better places of running steps may take.
constexpr milliseconds move_budget{2'000};
/// How long a moved instance is to be healthy before the next one is moved.
constexpr seconds healthy_for{10};
/// For instances of lower priority to be stop-safe and gone.
constexpr minutes eviction{10};
/// For one node to keep room, and how long it keeps it at most.
constexpr seconds reservation{10};
constexpr minutes longest_reservation{1};
/// How often a task is placed anew because nodes refused or left.
constexpr int placement_rounds = 3;
/// What one node's agent waits for its supervisor,
constexpr milliseconds agent_deployment{11 * 60'000 + 30'000};
/// what the coordinator's end of a session waits for the node,
constexpr milliseconds deployment{12 * 60'000};
/// and who wants the instance to run.
constexpr minutes deployment_answer{13};
/// The same for removal.
constexpr milliseconds agent_removal{48'000};
constexpr milliseconds removal{52'000};
constexpr milliseconds removal_answer{55'000};
/// To end instances of a task and to start them again.
constexpr seconds restart{870};

/// Events that are kept of a task: its first ones and the newest; and for how
/// many tasks, those that are gone too.
constexpr size_t first_events = 50;
constexpr size_t newest_events = 150;
constexpr size_t histories = 128;
/// Most of each text in such an event.
constexpr size_t event_text_bytes = 512;

/// The longest that a query may wait for a change of a task
/// (messages/task.hpp), and how many wait at a time: half of the clients that
/// an HTTP server works for at once.
constexpr milliseconds change_wait{20'000};
constexpr size_t change_waiters = 32;

/// A termination whose record cannot be removed for so long is answered with
/// the problem; the removal goes on.
constexpr seconds unwritten{15};
constexpr seconds termination{80};

/// For the others of a deployment that failed to be removed.
constexpr seconds rollback{60};

/// For a task's turn, or for the first reply to the same request: whoever asks
/// gives up before that.
constexpr minutes claim{16};

/// Claims that wait for their turn, and repetitions of one request that wait
/// for its first reply.
constexpr size_t waiting = 256;
constexpr size_t same_requests = 64;

/// Tasks at a time, whatever their state.
constexpr size_t most = 1000;

/// Tasks whose steps have all ended that are kept; the oldest go.
constexpr size_t settled = 100;

/// Terminated tasks that are remembered, to answer a repeated termination.
constexpr size_t terminated = 100;

/// Instances of all nodes of which it is known that they may run. Beyond it
/// nothing more is started.
constexpr size_t places = 16'384;
/// What was told to end when the coordinator was started again is started anew
/// where it fits; nodes that were away with it come back meanwhile.
constexpr minutes return_of_nodes{2};

/// Instances of all nodes that were not removed in time and are asked for
/// again; beyond it a node hears of it at its next registration.
constexpr size_t overdue_removals = 1000;

static_assert(allocation_budget < search && offline_allocation_budget < search);
static_assert(2 * move_budget < search);
static_assert(local::part < reservation);
static_assert(reservation < longest_reservation);
static_assert(store::write < local::answer && local::answer < deployment);
static_assert(instance::deployment < agent_deployment);
static_assert(agent_deployment < deployment - session::margin);
static_assert(deployment < deployment_answer);
static_assert(instance::removal < agent_removal);
static_assert(agent_removal < removal - session::margin);
static_assert(removal < removal_answer);
static_assert(removal_answer + unwritten + store::write < termination);
static_assert(removal_answer < rollback);
static_assert(retry::longest < return_of_nodes);

} // namespace task

/// Moving a node from one cell to another.
namespace transfer {

/// For a node that has left to be seen in its new cell.
constexpr seconds arrival{25};
/// How long the other coordinator keeps a place for it.
constexpr minutes place{2};
/// For one that another coordinator carries out: instances may have to be
/// started elsewhere first.
constexpr milliseconds forwarded = task::deployment + minutes{2};
/// For the node to be let go: what is not stop-safe by then keeps it here.
constexpr milliseconds preparing = task::deployment_answer;
/// What the request for it waits.
constexpr milliseconds answer = forwarded + seconds{30};
/// Ended ones that are remembered.
constexpr size_t ended = 100;

static_assert(arrival + task::termination < place);
static_assert(task::removal_answer + task::deployment_answer < task::restart);
static_assert(task::deployment_answer < forwarded);
static_assert(task::eviction < preparing && preparing < forwarded);

} // namespace transfer

/// Requests from outside.
namespace request {

/// The router's limit for a handler or a pipeline,
constexpr minutes handler{15};
/// and the HTTP side's for the router.
constexpr minutes router{16};
/// Answers that are remembered for the case that a request comes again, and
/// the memory that they may take with their requests.
constexpr size_t remembered = 256;
constexpr size_t remembered_bytes = 4 * mib;

/// For a coordinator's answer from what it knows that a member passes on: what
/// the coordinator's end of the session waits for it, and the member.
constexpr milliseconds forwarded_query = local::answer + seconds{2};
constexpr milliseconds member_query = forwarded_query + seconds{2};
/// The same for a request that makes the coordinator do something.
constexpr milliseconds forwarded = handler + seconds{15};
constexpr milliseconds member_request = forwarded + seconds{15};

static_assert(task::deployment_answer < handler && handler < router);
static_assert(task::restart < handler && task::eviction < handler);
static_assert(local::answer < forwarded_query && handler < forwarded);
static_assert(member_request < router);
static_assert(handler < task::claim);
static_assert(transfer::answer < handler);

} // namespace request

/// Logs of instances. Each holds beyond what the query wants to wait, and who
/// is farther from the instance has more.
namespace log {

/// The longest wait that a query may ask for (messages/instance.hpp).
constexpr milliseconds wait{20'000};

constexpr seconds runtime{5};
constexpr seconds agent{6};
constexpr seconds session{10};
constexpr seconds coordinator{12};
constexpr seconds answer{14};
constexpr seconds stream{60};
/// A program that prints without end wakes the io thread this often at most.
constexpr milliseconds change_pause{20};
/// Followers at a time. Who comes later is answered at once.
constexpr size_t followers = 64;
/// Most bytes in one part.
constexpr int64_t part_bytes = 64 * kib;

static_assert(runtime < agent && agent < session - limits::session::margin);
static_assert(session < coordinator && coordinator < answer);
static_assert(wait + answer < stream);

} // namespace log

/// What one HTTP server puts up with.
namespace http {

/// Request line and header fields together; more is answered with 431.
constexpr size_t header_bytes = 8 * kib;
/// A request's body; more is answered with 413 before it is read.
/// `document_limits` (schemas/document.hpp) takes JSON of this size.
constexpr size_t body_bytes = mib;
/// The same for unauthenticated peers, on the few paths that are open to them:
/// more than the longest registration switch.
constexpr size_t public_body_bytes = 8 * kib;
/// From connecting to the first byte.
constexpr milliseconds first_byte{10'000};
/// From a request's first byte to its last.
constexpr milliseconds whole_request{10'000};
/// Between two requests of one connection.
constexpr milliseconds idle{30'000};
/// For writing one reply to a slow reader.
constexpr milliseconds write{30'000};
/// For requests in progress when the server stops, and for a client to read
/// the error that ended its connection.
constexpr milliseconds grace{1000};
/// Of a client whose request was refused: what it still sends is read, so
/// that it gets to read the reply, but not without end.
constexpr size_t lingered_bytes = mib;
/// TCP connections that have not shown the bearer token yet. When one more
/// comes, the one that was silent for longest is closed: a crowd of silent
/// connections keeps nobody out who speaks at once.
constexpr size_t unauthenticated_peers = 64;
/// TCP connections that shake hands for a session, with the same rule: those of
/// a whole cell may come at one moment.
constexpr size_t joining = 256;
/// TCP connections that have shown it; one more is answered with 503.
constexpr size_t trusted = 192;
/// Connections to the Unix socket that are served at a time, those that wait
/// for their turn, and how long one waits before it is answered with 503, as
/// one more is at once.
constexpr size_t local = 64;
constexpr size_t waiting = 448;
constexpr seconds turn{60};
/// Clients that are being told that there is no room: each reads its 503 within
/// `grace`. One more is closed without a word.
constexpr size_t refused = 128;
/// Sessions; a request for one more is answered with 503.
constexpr size_t sessions = 1024;
/// Bytes that wait for one slow reader of a stream; beyond it, it is cut.
constexpr size_t stream_bytes = mib;
/// A client of a stream has nothing to say; a little is tolerated.
constexpr size_t stream_ignored_bytes = 64 * kib;
/// Replies that a client takes: of a node that it was pointed to, of another
/// node while it forms a cell, and one line of a stream.
constexpr size_t client_reply_bytes = 64 * mib;
constexpr size_t exchanged_bytes = 64 * kib;
constexpr size_t client_line_bytes = mib;
/// What a client waits where nothing else is said.
constexpr seconds client_timeout{30};
/// Ports that the system hands out for UDP are rarely taken for TCP.
constexpr int port_attempts = 16;
/// After the process ran out of descriptors.
constexpr milliseconds shortage_pause{100};

} // namespace http

/// Secrets.
namespace token {

/// A site token shorter than this could be guessed.
constexpr size_t least_site_bytes = 16;
constexpr size_t most_bytes = 4 * kib;
/// For a registration switch to come with the nonce that it was given.
constexpr seconds nonce_lifetime{10};
/// Nonces that have proven a switch and are not too old yet. More switches in
/// that time are refused.
constexpr size_t spent_nonces = 64;
/// At its start a coordinator asks those that claim to be what it is for a
/// proof: so many at once, for so long at most. Who is silent has none.
constexpr size_t claims = 64;
constexpr milliseconds claim_proof{1500};

static_assert(cell::registration_call < nonce_lifetime);

} // namespace token

/// What a node counts of itself.
namespace metric {

/// Sets of labels that one family may have.
constexpr size_t label_sets = 512;

} // namespace metric

/// Names and numbers that unauthenticated peers send. The schemas say the same.
namespace text {

constexpr size_t name_bytes = 63;
constexpr size_t uuid_bytes = 64;

} // namespace text

/// The node's events.
namespace event {

/// How many are in memory, for a listener that comes late.
constexpr size_t kept = 1000;
/// Refusals of one kind that are told one by one in this time; those beyond
/// are counted. Whoever provokes them without end adds six events a minute.
constexpr size_t refusals = 5;
constexpr seconds refusal_window{60};
/// What happens to one instance or task again and again is kept so often in
/// this time, and then counted: told after such a time, then after times each
/// twice the one before.
constexpr size_t repetitions = 10;
constexpr seconds repetition_window{60};
constexpr minutes longest_repetition_window{60};
/// Series that are looked at; what is beyond them is kept one by one.
constexpr size_t series = 1024;

static_assert(repetitions < kept && refusals < kept);

} // namespace event

/// What a node keeps on its disk of what was said: events, and logs of
/// instances that are gone.
namespace history {

/// All of it; `--history-bytes` and `--history-age` set others.
constexpr size_t bytes = 64 * mib;
constexpr std::chrono::hours age{7 * 24};
/// Events are written together: those of so much time, or so many. A loss of
/// power takes no more. In between they are in memory, with those kept there.
constexpr seconds batch_span{20};
constexpr size_t batch = 256;
/// For a batch on a slow disk, and for a part of the past.
constexpr seconds disk{8};
/// For the last batch, as a node that ends has `membership::stopping` for all.
constexpr seconds last_batch{2};
/// A file of events that is larger, or older, gets no more of them: it goes as
/// a whole. At most as many files as `bytes` holds of them are there.
constexpr size_t file_bytes = mib;
constexpr std::chrono::hours file_age{12};
/// Longest line that is read back; longer ones are not ours.
constexpr size_t line_bytes = 64 * kib;
/// Events and bytes in one part of an answer, and the most that can be asked
/// for as the newest.
constexpr size_t part = 256;
constexpr size_t part_bytes = 256 * kib;
constexpr size_t newest = 10'000;
/// Numbers that are set aside at a time, and when it is done again.
constexpr uint64_t numbers = 4096;
/// The least that may be kept: less could hold not even one file.
constexpr size_t least_bytes = 2 * file_bytes;

/// Logs that are kept at most, however small they are,
constexpr size_t logs = 2000;
/// and of one instance: those of its last runs.
constexpr size_t runs = 3;
/// Logs that are told of at a time (messages/kept_log.hpp).
constexpr size_t listed_logs = 1000;
/// Most bytes of what is noted beside a log.
constexpr size_t about_bytes = 16 * kib;
/// For the list of all kept logs of this node.
constexpr seconds list{3};
/// For a coordinator to have it from its members: those that are silent are
/// left out.
constexpr seconds member_list{5};
constexpr seconds cell_list{7};

static_assert(list <= member_list - session::margin);
static_assert(member_list < cell_list && cell_list < local::answer);
static_assert(2 * batch < event::kept);
static_assert(last_batch < membership::stopping);
static_assert(disk < local::answer);
static_assert(2 * event::kept < numbers);
static_assert(least_bytes < bytes);

} // namespace history

/// The folders of skills on a node.
namespace skill {

constexpr size_t most = 1024;
/// Longest descriptor that is read.
constexpr size_t descriptor_bytes = mib;
/// Longest path, which is shown as an instance's image
/// (schemas/common.schema.json).
constexpr size_t path_bytes = 512;
/// Errors of one descriptor that are told.
constexpr size_t errors = 20;

/// Folders that are no skills of which the rest of the cell is told, and the
/// bytes of each text about them.
constexpr size_t published_problems = 32;
constexpr size_t reported_text_bytes = kib;

} // namespace skill

/// Discovery by DDS. DDS leases decide nothing.
namespace discovery {

/// Fast DDS's own periods cost 194 B/s a member, these about 3.
constexpr seconds lease{600};
constexpr seconds announcement_period{200};
/// For the coordinators of the site to be seen at the start.
constexpr milliseconds survey{60};
/// The same where somebody has claimed a name that is not his: its owner may be
/// slower, on a busy host or a long way.
constexpr milliseconds second_survey{500};
/// The most bytes of USER_DATA that we send or look at: enough for the longest
/// names that a session takes, all of whose bytes are escaped.
constexpr size_t announcement_bytes = 1024;
/// So many presences on one host are reached by the host's address alone.
constexpr unsigned presence_places = 4;
/// For the names of all peers to be looked up: who waits for discovery has
/// `local::part` for it.
constexpr milliseconds peer_names{2000};

static_assert(peer_names < local::part);

static_assert(2 * announcement_period < lease);

} // namespace discovery

} // namespace roscell::limits
